import { h } from "../dom";

/** A choice from a few values, with a label for screen readers. */
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

/** A box to tick with its words. */
export function tickBox(text: string, hint: string, changed: (ticked: boolean) => void): HTMLLabelElement & { box: HTMLInputElement } {
  const box = h("input", { class: "check" });
  box.type = "checkbox";
  box.addEventListener("change", () => changed(box.checked));
  return Object.assign(h("label", { class: "tick", title: hint }, box, text), { box });
}

/** A field for a text; `typed` is called for every key. */
export function textField(label: string, typed: (text: string) => void, className = "field"): HTMLInputElement {
  const element = h("input", { class: className, title: label, aria: { label } });
  element.placeholder = label;
  element.spellcheck = false;
  element.addEventListener("input", () => typed(element.value));
  return element;
}

/** A field for a number; an entry that is not a number, or out of bounds, is ignored. */
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
