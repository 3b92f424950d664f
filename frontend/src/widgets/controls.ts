import { h } from "../dom";

/** Returns a select element with a label for screen readers. */
export function choice<T extends string>(
  label: string,
  options: readonly (readonly [T, string])[],
  chosen: (value: T) => void,
): HTMLSelectElement {
  const element = h("select", { class: "choice", title: label, aria: { label } });
  element.append(...options.map(([value, text]) => new Option(text, value)));
  element.addEventListener("change", () => chosen(element.value as T));
  return element;
}

/** Returns a tick box with a label; `box` is its input element. */
export function tickBox(text: string, hint: string, changed: (ticked: boolean) => void): HTMLLabelElement & { box: HTMLInputElement } {
  const box = h("input", { class: "check" });
  box.type = "checkbox";
  box.addEventListener("change", () => changed(box.checked));
  return Object.assign(h("label", { class: "tick", title: hint }, box, text), { box });
}

/** Returns a text field; `typed` is called on every input. */
export function textField(label: string, typed: (text: string) => void, className = "field"): HTMLInputElement {
  const element = h("input", { class: className, title: label, aria: { label } });
  element.placeholder = label;
  element.spellcheck = false;
  element.addEventListener("input", () => typed(element.value));
  return element;
}

/** Returns a number field that ignores invalid numbers and those out of bounds. */
export function numberField(
  label: string,
  value: number,
  [least, most]: readonly [number, number],
  taken: (value: number) => void,
): HTMLInputElement {
  const element = h("input", { class: "field numeric", title: label, aria: { label } });
  element.inputMode = "decimal";
  element.value = String(value);
  let last = value;
  element.addEventListener("change", () => {
    const number = element.value.trim() === "" ? NaN : Number(element.value);
    if (number >= least && number <= most) taken((last = number));
    element.value = String(last);
  });
  return element;
}
