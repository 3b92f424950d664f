import { h } from "../../dom";
import { createSelect } from "../../widgets/controls";

/** A labeled control of the panel's form. */
export interface FormRow {
  readonly element: HTMLElement;
}

/** A number whose value also changes elsewhere, such as in another page. */
export class NumberSetting implements FormRow {
  readonly element: HTMLElement;
  private readonly input = h("input", { class: "field numeric" });
  private value = NaN;

  constructor(
    label: string,
    hint: string,
    unit: string,
    private readonly limits: readonly [number, number],
    private readonly onAccepted: (value: number) => void,
  ) {
    this.input.type = "text";
    this.input.inputMode = "decimal";
    this.input.title = hint;
    this.input.setAttribute("aria-label", label);
    this.input.addEventListener("change", () => this.accept());
    this.element = h("div", { class: "planning-row" }, h("span", { class: "toolbar-label" }, label), this.input, h("span", { class: "unit" }, unit));
  }

  show(value: number): void {
    this.value = value;
    if (document.activeElement !== this.input) this.input.value = String(Number(value.toFixed(4)));
  }

  private accept(): void {
    const [minimum, maximum] = this.limits;
    const number = this.input.value.trim() === "" ? NaN : Number(this.input.value);
    if (number >= minimum && number <= maximum) this.onAccepted((this.value = number));
    this.input.value = String(Number(this.value.toFixed(4)));
  }
}

/** A choice among options that change. */
export class ChoiceSetting implements FormRow {
  readonly element: HTMLElement;
  private readonly select: HTMLSelectElement;
  private shownOptions = "";

  constructor(label: string, onChosen: (value: string) => void, ...extras: readonly HTMLElement[]) {
    this.select = createSelect<string>(label, [], onChosen);
    this.element = h("div", { class: "planning-row" }, h("span", { class: "toolbar-label" }, label), this.select, ...extras);
  }

  get value(): string {
    return this.select.value;
  }

  /** Shows options as pairs of value and text; a value without an option is shown as `otherText`. */
  show(value: string, options: readonly (readonly [string, string])[], otherText = ""): void {
    const hasValue = options.some(([option]) => option === value);
    const allOptions = hasValue ? options : [[value, otherText] as const, ...options];
    const key = JSON.stringify(allOptions);
    if (key !== this.shownOptions) {
      this.shownOptions = key;
      this.select.replaceChildren(...allOptions.map(([option, text]) => new Option(text, option)));
    }
    if (this.select.value !== value) this.select.value = value;
  }
}
