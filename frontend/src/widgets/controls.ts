import { h } from "../dom";

/** Returns a select element with a label for screen readers. */
export function createSelect<T extends string>(
  label: string,
  options: readonly (readonly [T, string])[],
  onChosen: (value: T) => void,
): HTMLSelectElement {
  const element = h("select", { class: "choice", title: label, aria: { label } });
  element.append(...options.map(([value, text]) => new Option(text, value)));
  element.addEventListener("change", () => onChosen(element.value as T));
  return element;
}

/** Returns a tick box with a label; `box` is its input element. */
export function createTickBox(text: string, hint: string, onChanged: (isTicked: boolean) => void): HTMLLabelElement & { box: HTMLInputElement } {
  const box = h("input", { class: "check" });
  box.type = "checkbox";
  box.addEventListener("change", () => onChanged(box.checked));
  return Object.assign(h("label", { class: "tick", title: hint }, box, text), { box });
}

/** Returns a text field; `onTyped` is called on every input. */
export function createTextField(label: string, onTyped: (text: string) => void, className = "field"): HTMLInputElement {
  const element = h("input", { class: className, title: label, aria: { label } });
  element.placeholder = label;
  element.spellcheck = false;
  element.addEventListener("input", () => onTyped(element.value));
  return element;
}

/** Returns a number field that rejects invalid numbers and numbers out of bounds. */
export function createNumberField(
  label: string,
  value: number,
  [minimum, maximum]: readonly [number, number],
  onAccepted: (value: number) => void,
): HTMLInputElement {
  const element = h("input", { class: "field numeric", title: label, aria: { label } });
  element.inputMode = "decimal";
  element.value = String(value);
  let acceptedValue = value;
  element.addEventListener("change", () => {
    const number = element.value.trim() === "" ? NaN : Number(element.value);
    if (number >= minimum && number <= maximum) onAccepted((acceptedValue = number));
    element.value = String(acceptedValue);
  });
  return element;
}
