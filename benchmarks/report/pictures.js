// The pictures stand behind the script, each in an element of its own, thumbnails first: the page is drawn before they are read,
// and the browser decodes one only where an image asks for it.
import {el} from "./dom.js";

const waiting = new Map();  // images, and the position of the picture that each is to show

/** The picture's data URI; undefined until all of it is read. */
function read(position) {
  const element = document.getElementById(`picture-${position}`);
  return element?.nextSibling || document.readyState !== "loading" ? element?.textContent : undefined;
}

function deliver() {
  for (const [image, position] of waiting) {
    const uri = read(position);
    if (!uri) continue;
    image.src = uri;
    waiting.delete(image);
  }
}
new MutationObserver(deliver).observe(document.body, {childList: true});
addEventListener("DOMContentLoaded", deliver);  // the last one has nothing behind it

/** Gives the image a picture, as soon as it is read. */
export function put(image, position) {
  image.removeAttribute("src");
  waiting.set(image, position);
  deliver();
}

export function picture(position, attributes) {
  const image = el("img", attributes);
  put(image, position);
  return image;
}
