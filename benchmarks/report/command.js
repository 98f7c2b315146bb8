// The command that renders a row's picture, to be copied.
import {el} from "./dom.js";

/** Where copying is refused the command is selected, so that the keyboard copies it. */
async function copy(code, button) {
  try {
    await navigator.clipboard.writeText(code.textContent);
    button.textContent = "Copied";
  } catch {
    getSelection().selectAllChildren(code);
    button.textContent = "Selected";
  }
}

/** A command with a button that copies it; nothing for rows that have none. */
export function command(row) {
  if (!row.command) return null;
  const code = el("code", {}, row.command);
  const button = el("button", {type: "button", "aria-live": "polite", click: () => copy(code, button)}, "Copy");
  return el("div", {class: "command"}, code, button);
}
