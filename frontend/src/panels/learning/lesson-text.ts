import { createButton, h } from "../../dom";
import { createIcon } from "../../icons";
import { strings } from "../../strings";
import { copyText } from "../../widgets/copy-text";
import { sanitizeHtml } from "../source-editor/safe-html";

/** The class of blocks that show output. */
const OUTPUT_CLASS = "language-text";

/**
 * Returns the text of a lesson as an element; code blocks get a button that copies them, unless they show output, and
 * tables scroll.
 */
export function createLessonText(html: string, className: string): HTMLElement {
  const element = h("div", { class: className });
  element.innerHTML = sanitizeHtml(html, { allowsImages: true });
  for (const code of element.querySelectorAll<HTMLElement>("pre > code")) {
    const wrapper = h("div", { class: "lesson-code" });
    code.parentElement?.replaceWith(wrapper);
    wrapper.append(h("pre", { tabIndex: 0 }, code));
    if (code.classList.contains(OUTPUT_CLASS)) continue;
    wrapper.append(createButton(strings.learning.copyHint, () => void copyText(code.textContent), "tool bare lesson-copy", createIcon("copy")));
  }
  for (const code of element.querySelectorAll(":not(pre) > code")) addBreaksAfterSlashes(code);
  for (const table of element.querySelectorAll("table")) {
    const wrapper = h("div", { class: "lesson-table", role: "group", tabIndex: 0, aria: { label: strings.learning.table } });
    table.replaceWith(wrapper);
    wrapper.append(table);
  }
  return element;
}

/** Allows line breaks after the inner slashes of a long path, so that punctuation after it stays with its last part. */
function addBreaksAfterSlashes(code: Element): void {
  const parts = code.textContent.split(/(?<=[^/]\/)/);
  code.replaceChildren(...parts.flatMap((part, index) => (index === 0 ? [part] : [h("wbr"), part])));
}
