import { button, h } from "../../dom";
import { icon } from "../../icons";
import { strings } from "../../strings";
import { copyText } from "../../widgets/copy-text";
import { safeHtml } from "../source-editor/safe-html";

/** Returns the text of a lesson as an element; code blocks get a button that copies them. */
export function lessonText(html: string, className: string): HTMLElement {
  const element = h("div", { class: className });
  element.innerHTML = safeHtml(html, { allowsImages: true });
  for (const code of element.querySelectorAll<HTMLElement>("pre > code")) {
    const copy = button(strings.learning.copyHint, () => void copyText(code.textContent), "tool bare lesson-copy", icon("copy"));
    const box = h("div", { class: "lesson-code" });
    code.parentElement?.replaceWith(box);
    box.append(h("pre", { tabIndex: 0 }, code), copy);
  }
  return element;
}
