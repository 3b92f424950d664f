import { h } from "../../dom";
import { createIcon } from "../../icons";
import type { ModelChoice } from "../../protocol";
import type { Modeling } from "../../state/modeling/modeling";
import { strings } from "../../strings";
import { Dialog } from "../../widgets/dialog";

/** Lets the user choose among the models on the search path; the next click in the scene places the model. */
export class ModelDialog {
  private readonly dialog: Dialog;
  private readonly search = h("input", { class: "field" });
  private readonly list = h("div", { class: "choices", role: "listbox", aria: { label: strings.modeling.models } });
  private models: readonly ModelChoice[] | null = null;
  private listedModels: readonly ModelChoice[] = [];
  private chosenModel: ModelChoice | null = null;

  constructor(private readonly modeling: Modeling) {
    const texts = strings.modeling;
    this.search.type = "search";
    this.search.placeholder = texts.search;
    this.search.setAttribute("aria-label", texts.search);
    this.search.addEventListener("input", () => this.fill());
    for (const element of [this.search, this.list]) element.addEventListener("keydown", (event) => this.onKeyDown(event));
    this.dialog = new Dialog(
      texts.models,
      [h("div", { class: "search-box" }, createIcon("search"), this.search), this.list],
      [{ label: strings.shell.cancel }, { label: texts.choose, isPrimary: true, run: () => this.placeChosenModel() }],
      "add-dialog",
    );
    const unsubscribe = modeling.modelsArrived.on((models) => {
      this.models = models;
      this.fill();
    });
    this.dialog.element.addEventListener("close", () => unsubscribe());
  }

  open(): void {
    this.dialog.open(this.search);
    this.fill();
    this.modeling.requestModels();
  }

  private fill(): void {
    const texts = strings.modeling;
    const query = this.search.value.trim().toLowerCase();
    this.listedModels = (this.models ?? []).filter(({ name, address }) => `${name} ${address}`.toLowerCase().includes(query));
    this.list.replaceChildren(...this.listedModels.map((model) => this.createRow(model)));
    if (this.models && this.listedModels.length === 0) {
      this.list.append(h("p", { class: "empty" }, this.models.length === 0 ? texts.noModels : texts.notFound));
    }
    this.chooseModel(this.listedModels.find(({ address }) => address === this.chosenModel?.address) ?? this.listedModels[0] ?? null);
  }

  private createRow(model: ModelChoice): HTMLElement {
    const { name, address } = model;
    const parts = [createIcon("library"), h("strong", {}, name), h("span", { class: "about" }, address)];
    const row = h("div", { class: "choice-row", role: "option", tabIndex: -1, onClick: () => this.chooseModel(model) }, ...parts);
    row.addEventListener("dblclick", () => {
      if (this.placeChosenModel()) this.dialog.close();
    });
    return row;
  }

  private chooseModel(model: ModelChoice | null): void {
    this.chosenModel = model;
    this.dialog.isReady = model !== null;
    [...this.list.querySelectorAll<HTMLElement>("[role=option]")].forEach((row, index) => {
      const isChosen = this.listedModels[index] === model;
      row.setAttribute("aria-selected", String(isChosen));
      row.tabIndex = isChosen ? 0 : -1;
    });
  }

  private onKeyDown(event: KeyboardEvent): void {
    if (event.key === "Enter" && event.target !== this.search && this.placeChosenModel()) this.dialog.close();
    const step = event.key === "ArrowDown" ? 1 : event.key === "ArrowUp" ? -1 : 0;
    const index = this.listedModels.findIndex((model) => model === this.chosenModel) + step;
    const nextModel = this.listedModels[index];
    if (step === 0 || !nextModel) return;
    event.preventDefault();
    this.chooseModel(nextModel);
    const row = this.list.querySelectorAll<HTMLElement>("[role=option]")[index];
    row?.scrollIntoView({ block: "nearest" });
    if (event.target !== this.search) row?.focus();
  }

  private placeChosenModel(): boolean {
    if (!this.chosenModel) return false;
    this.modeling.startPlacing({ kind: "model", address: this.chosenModel.address });
    return true;
  }
}
