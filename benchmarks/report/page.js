// What `limn bench` put into the page: tables, and how metrics and columns are called.
export const page = JSON.parse(document.getElementById("data").textContent);
