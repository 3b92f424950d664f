import { h } from "../../dom";
import type { Connection } from "../../connection/connection";
import type { ArgumentForm } from "../../protocol";
import { strings } from "../../strings";

/**
 * The form over the scene while the description lacks arguments: a field for each, and the values that launch files
 * pass.
 */
export class ArgumentFormCard {
  readonly element = h("form", { class: "argument-form", aria: { label: strings.scene.arguments.label } });
  private fields = new Map<string, HTMLInputElement>();

  constructor(private readonly connection: Connection) {
    this.element.hidden = true;
    this.element.addEventListener("submit", (event) => {
      event.preventDefault();
      this.submit();
    });
    // Keys of the scene must not act while values are typed.
    this.element.addEventListener("keydown", (event) => event.stopPropagation());
    connection.on("argument_form", (form) => this.show(form));
  }

  private show(form: ArgumentForm): void {
    const texts = strings.scene.arguments;
    const { file, names, values, choices } = form;
    this.element.hidden = file === "";
    if (file === "") return;
    this.fields = new Map(names.map((name) => [name, createField(name, values[name] ?? "")]));
    const submit = h("button", { class: "tool framed primary" }, texts.show);
    submit.type = "submit";
    const rows = [...this.fields].map(([name, input]) => h("label", { class: "argument-row" }, h("span", {}, name), input));
    this.element.replaceChildren(
      h("h2", {}, texts.title(file)),
      h("p", {}, choices.length > 0 ? texts.known : texts.unknown),
      ...(choices.length > 1 ? [this.createChoiceRow(form)] : []),
      h("div", { class: "argument-rows" }, ...rows),
      h("footer", {}, submit),
    );
    if (document.activeElement === document.body) this.element.querySelector<HTMLElement>("select, input")?.focus();
  }

  /** Returns a choice of the argument sets found in launch files; choosing one fills the fields. */
  private createChoiceRow({ choices, names }: ArgumentForm): HTMLElement {
    const texts = strings.scene.arguments;
    const select = h("select", { class: "choice", aria: { label: texts.choose } });
    select.append(...choices.map(({ label }, index) => new Option(label, String(index))));
    select.addEventListener("change", () => {
      const values = choices[Number(select.value)]?.values ?? {};
      for (const name of names) {
        const input = this.fields.get(name);
        if (input) input.value = values[name] ?? "";
      }
    });
    return h("label", { class: "argument-row" }, h("span", {}, texts.choose), select);
  }

  /** Sends the values. Empty fields are omitted: the file then uses its default, or reports the missing argument. */
  private submit(): void {
    const givenValues = [...this.fields].map(([name, { value }]) => [name, value.trim()] as const).filter(([, value]) => value !== "");
    this.connection.send({ type: "set_arguments", values: Object.fromEntries(givenValues) });
  }
}

function createField(name: string, value: string): HTMLInputElement {
  const input = h("input", { class: "field wide", aria: { label: name } });
  input.value = value;
  input.spellcheck = false;
  return input;
}
