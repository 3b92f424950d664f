import { h } from "../../dom";
import type { ParameterKind, ParameterRow } from "../../protocol";
import { formatParameter, parseParameter } from "../../state/monitor/parameter-text";
import { strings } from "../../strings";

/**
 * A parameter with an editor for its type. A value is sent when its input is complete, and applies once the node
 * confirms it.
 */
export class ParameterLine {
  readonly element: HTMLElement;
  private readonly editor: HTMLInputElement;
  private readonly slider: HTMLInputElement | null;
  private readonly problem = h("div", { class: "parameter-problem", role: "alert" });
  private row: ParameterRow;

  constructor(
    row: ParameterRow,
    private readonly setParameter: (name: string, kind: ParameterKind, values: string[]) => void,
  ) {
    const texts = strings.monitor.parameters;
    this.row = row;
    this.editor = row.kind === "bool" ? h("input", { class: "check" }) : h("input", { class: "field" });
    this.editor.type = row.kind === "bool" ? "checkbox" : "text";
    this.editor.spellcheck = false;
    this.editor.setAttribute("aria-label", row.name);
    this.editor.disabled = row.read_only || row.kind === "not_set";
    if (row.kind === "integer" || row.kind === "double") {
      this.editor.inputMode = "decimal";
      this.editor.classList.add("numeric");
    }
    this.slider = this.createSlider();
    this.bindInputs();
    const range = row.minimum === "" ? "" : texts.range(row.minimum, row.maximum, row.step);
    const hint = [row.description, row.constraints].filter((text) => text !== "").join(" ");
    const notes = [texts.kinds[row.kind], row.read_only ? texts.readOnly : "", range].filter((text) => text !== "");
    this.element = h(
      "div",
      { class: "parameter", data: { parameter: row.name }, title: hint },
      h("div", { class: "parameter-name" }, row.name),
      h("div", { class: "parameter-value" }, this.editor, this.slider),
      h("div", { class: "parameter-notes note" }, notes.join(" · "), hint === "" ? "" : h("div", {}, hint)),
      this.problem,
    );
    this.problem.hidden = true;
    this.show(row);
  }

  /** Whether this line can show a row: its editor suits one type and range only. */
  isSameParameter(row: ParameterRow): boolean {
    const editorKeyOf = ({ kind, read_only, minimum, maximum, description }: ParameterRow): string =>
      JSON.stringify([kind, read_only, minimum, maximum, description]);
    return editorKeyOf(row) === editorKeyOf(this.row);
  }

  /** Shows the value that the node has, except over text that the user is editing. */
  show(row: ParameterRow): void {
    this.row = row;
    if (row.kind === "bool") this.editor.checked = row.values[0] === "true";
    else if (document.activeElement !== this.editor) this.editor.value = this.formatEditorText();
    if (this.slider && document.activeElement !== this.slider) this.slider.value = row.values[0] ?? "0";
  }

  /** Shows the result of setting the parameter: its current value, and the reason for a refusal. */
  showResult(isSuccessful: boolean, reason: string): void {
    this.problem.hidden = isSuccessful;
    this.problem.textContent = isSuccessful ? "" : reason || strings.monitor.parameters.refused;
    this.element.classList.toggle("wrong", !isSuccessful);
    if (isSuccessful) return;
    if (this.row.kind === "bool") this.editor.checked = this.row.values[0] === "true";
    if (this.slider) this.slider.value = this.row.values[0] ?? "0";
  }

  private formatEditorText(): string {
    return this.row.kind === "not_set" ? strings.monitor.parameters.notSet : formatParameter(this.row.kind, this.row.values);
  }

  private createSlider(): HTMLInputElement | null {
    const { kind, minimum, maximum, step, read_only, name } = this.row;
    const [low, high] = [Number(minimum), Number(maximum)];
    if (minimum === "" || read_only || !Number.isFinite(high - low) || high <= low) return null;
    const slider = h("input", { class: "parameter-slider", aria: { label: name } });
    slider.type = "range";
    slider.min = minimum;
    slider.max = maximum;
    slider.step = step !== "" ? step : kind === "integer" ? "1" : String((high - low) / 200);
    slider.addEventListener("input", () => (this.editor.value = shortenNumber(slider.value)));
    slider.addEventListener("change", () => this.send([shortenNumber(slider.value)]));
    return slider;
  }

  private bindInputs(): void {
    if (this.row.kind === "bool") {
      this.editor.addEventListener("change", () => this.send([String(this.editor.checked)]));
      return;
    }
    this.editor.addEventListener("change", () => this.sendText());
    this.editor.addEventListener("keydown", (event) => {
      if (event.key === "Escape") {
        this.editor.value = this.formatEditorText();
        this.showResult(true, "");
        this.editor.blur();
      } else if (event.key === "Enter") this.sendText();
    });
  }

  private sendText(): void {
    if (this.editor.value === this.formatEditorText()) return;
    const values = parseParameter(this.row.kind, this.editor.value);
    if (values === null) this.showResult(false, strings.monitor.parameters.unreadable);
    else this.send(values);
  }

  private send(values: string[]): void {
    this.setParameter(this.row.name, this.row.kind, values);
  }
}

function shortenNumber(text: string): string {
  return String(Number(Number(text).toPrecision(10)));
}
