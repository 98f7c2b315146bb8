// Pictures over the whole window, which flip in place: differences show where two of them alternate.
import {el, isShortcut} from "./dom.js";
import {put} from "./pictures.js";

/** Shows `pictures`, [{whole, name, text}], beginning with number `start`. Arrow keys and the space bar flip, Escape closes. */
export function enlarge(pictures, start) {
  let shown = start, before = (start + 1) % pictures.length;
  const image = el("img", {class: "enlarged"});
  const buttons = pictures.map(({name}, i) => el("button", {type: "button", click: () => show(i)}, name));
  const show = (i) => {
    if (i !== shown) before = shown;
    shown = i;
    put(image, pictures[i].whole);
    image.alt = pictures[i].text;
    buttons.forEach((button, k) => button.setAttribute("aria-pressed", String(k === i)));
  };
  const count = pictures.length;
  const steps = {ArrowRight: () => (shown + 1) % count, ArrowLeft: () => (shown + count - 1) % count, " ": () => before};
  const dialog = el("dialog", {"aria-label": "Enlarged picture", close: () => dialog.remove(),
    keydown: (event) => {
      if (!steps[event.key] || isShortcut(event) || (event.key === " " && "close" in event.target.dataset)) return;
      event.preventDefault();
      show(steps[event.key]());
    }},
    el("div", {class: "tools"}, count > 1 ? buttons : null,
      el("button", {type: "button", "data-close": true, click: () => dialog.close()}, "Close"),
      count > 1 ? el("span", {class: "note"}, "Arrow keys flip; the space bar alternates two.") : null),
    image);
  document.body.append(dialog);
  show(start);
  dialog.showModal();
  (buttons[start].isConnected ? buttons[start] : dialog.querySelector("[data-close]")).focus();
}
