import { h } from "../../dom";
import { createIcon } from "../../icons";
import type { ModelChoice } from "../../protocol";
import type { Modeling } from "../../state/modeling/modeling";
import type { SimulationState } from "../../state/simulation";
import { strings } from "../../strings";
import { Dialog } from "../../widgets/dialog";

/**
 * The dialog that adds a model to the world, from the search path or from a file; it stays open until the model exists.
 */
export class SpawnDialog {
  private readonly dialog: Dialog;
  private readonly location = h("input", { class: "field", aria: { label: strings.simulation.address } });
  private readonly positionFields: readonly HTMLInputElement[];
  private readonly list = h("div", { class: "choices", role: "listbox", aria: { label: strings.simulation.models } });
  private readonly message = h("p", { class: "problem", role: "alert" });
  private models: readonly ModelChoice[] | null = null;

  constructor(
    private readonly simulation: SimulationState,
    modeling: Modeling,
    position: readonly number[],
    onClosed: () => void,
  ) {
    const texts = strings.simulation;
    this.location.placeholder = texts.addressHint;
    this.location.addEventListener("input", () => this.onLocationChanged());
    this.positionFields = position.map((value, axis) => {
      const field = h("input", { class: "field number", aria: { label: "xyz"[axis] ?? "" } });
      field.value = String(Math.round(value * 1000) / 1000);
      return field;
    });
    const rows = [
      h("label", { class: "spawn-row" }, h("span", {}, texts.address), this.location),
      this.list,
      h("div", { class: "spawn-row" }, h("span", {}, texts.position), h("span", { class: "spawn-places" }, ...this.positionFields)),
      this.message,
    ];
    const dialogButtons = [{ label: strings.shell.cancel }, { label: texts.spawn, isPrimary: true, run: () => this.submit() }];
    this.dialog = new Dialog(texts.spawnTitle, rows, dialogButtons, "spawn-dialog");
    const unsubscribers = [
      modeling.modelsArrived.on((models) => {
        this.models = models;
        this.renderModels();
      }),
      simulation.added.on(() => this.dialog.close()),
      simulation.refused.on((text) => this.showProblem(text)),
    ];
    this.dialog.element.addEventListener("close", () => {
      for (const unsubscribe of unsubscribers) unsubscribe();
      onClosed();
    });
    this.dialog.open(this.location);
    this.onLocationChanged();
    modeling.requestModels();
  }

  /** Removes the message about the previous location. */
  private onLocationChanged(): void {
    this.renderModels();
    this.dialog.isReady = this.location.value.trim() !== "";
    this.message.textContent = "";
  }

  /** Lists the models whose names contain the typed text; all models once one of them is chosen. */
  private renderModels(): void {
    const texts = strings.simulation;
    const query = this.location.value.trim();
    const models = this.models ?? [];
    const isModelChosen = models.some(({ address }) => address === query);
    const listedModels = isModelChosen ? models : models.filter(({ name }) => name.toLowerCase().includes(query.toLowerCase()));
    this.list.replaceChildren(...listedModels.map((model) => this.createRow(model, model.address === query)));
    this.list.role = listedModels.length > 0 ? "listbox" : "group"; // a listbox must have options
    if (this.models && listedModels.length === 0) {
      this.list.append(h("p", { class: "empty" }, models.length === 0 ? texts.noModels : texts.notListed));
    }
  }

  private createRow(model: ModelChoice, isChosen: boolean): HTMLElement {
    const { name, address } = model;
    const choose = (): void => {
      this.location.value = address;
      this.onLocationChanged();
      this.list.querySelector<HTMLElement>("[aria-selected=true]")?.focus();
    };
    const parts = [createIcon("library"), h("strong", {}, name), h("span", { class: "about" }, address)];
    const row = h("div", { class: "choice-row", role: "option", tabIndex: 0, aria: { selected: String(isChosen) }, onClick: choose }, ...parts);
    row.addEventListener("keydown", (event) => {
      if (event.key === "Enter" || event.key === " ") choose();
      else if (event.key === "ArrowDown") (row.nextElementSibling as HTMLElement | null)?.focus();
      else if (event.key === "ArrowUp") (row.previousElementSibling as HTMLElement | null)?.focus();
      else return;
      event.preventDefault();
    });
    return row;
  }

  private submit(): boolean {
    const location = this.location.value.trim();
    const numbers = this.positionFields.map((field) => Number(field.value));
    if (location === "" || numbers.some((number) => !Number.isFinite(number))) return false;
    const model = this.models?.find(({ name }) => name === location);
    this.simulation.spawn(model?.address ?? location, numbers);
    this.dialog.isReady = false;
    this.message.classList.remove("problem");
    this.message.textContent = strings.simulation.adding;
    return false;
  }

  private showProblem(text: string): void {
    this.message.classList.add("problem");
    this.message.textContent = text;
    this.dialog.isReady = true;
  }
}
