import { createButton, h } from "../../dom";
import type { ControllerRow, HardwareRow } from "../../protocol";
import { listActions, listHardwareStates, type ControllersState } from "../../state/monitor/controllers";
import { strings } from "../../strings";
import { createSelect } from "../../widgets/controls";
import { onVisibilityChange } from "../../widgets/visibility";
import type { Panel } from "../panel";

/** The controllers and the hardware of a controller manager, as in rqt_controller_manager. */
export class ControllersPanel implements Panel {
  readonly id = "controllers";
  readonly icon = "controllers";
  readonly element: HTMLElement;
  private readonly managers: HTMLSelectElement;
  private readonly controllers = h("tbody");
  private readonly hardware = h("tbody");
  private readonly note = h("p", { class: "empty" });
  private readonly tables: readonly HTMLElement[];

  constructor(private readonly state: ControllersState) {
    const texts = strings.monitor.controllers;
    this.managers = createSelect(texts.manager, [], (manager) => state.choose(manager));
    this.tables = [
      createTable([texts.controller, texts.state, "", texts.type, texts.interfaces], this.controllers),
      createTable([texts.hardware, texts.state, "", texts.plugin, texts.interfaces], this.hardware),
    ];
    const toolbar = h("div", { class: "toolbar" }, this.managers);
    this.element = h("div", { class: "panel monitor" }, toolbar, h("div", { class: "scroll" }, this.note, ...this.tables));
    state.managersChanged.on(() => this.showManagers());
    state.changed.on(() => this.show());
    onVisibilityChange(this.element, (isVisible) => state.watch(isVisible));
    this.showManagers();
    this.show();
  }

  private showManagers(): void {
    const { managers, manager } = this.state;
    this.managers.replaceChildren(...managers.map((name) => new Option(name, name, false, name === manager)));
    this.managers.hidden = managers.length === 0;
    this.show();
  }

  private show(): void {
    const texts = strings.monitor.controllers;
    const { list, manager } = this.state;
    if (manager !== null) this.managers.value = manager;
    const note = manager === null ? texts.none : list === null ? texts.waiting : (list.error ?? "");
    this.note.textContent = note;
    this.note.hidden = note === "";
    for (const table of this.tables) table.hidden = note !== "";
    this.controllers.replaceChildren(...(list?.controllers ?? []).map((row) => this.createControllerRow(row)));
    this.hardware.replaceChildren(...(list?.hardware ?? []).map((row) => this.createHardwareRow(row)));
  }

  private createControllerRow({ name, kind, state, claimed }: ControllerRow): HTMLElement {
    const texts = strings.monitor.controllers;
    const buttons = listActions(state).map((action) =>
      createButton(texts.actionHints[action](name), () => this.state.changeController(name, action), "tool", texts.actions[action]),
    );
    return this.createRow(name, state, kind, claimed, buttons);
  }

  private createHardwareRow({ name, plugin, state, commands }: HardwareRow): HTMLElement {
    const texts = strings.monitor.controllers;
    const buttons = listHardwareStates(state).map((target) =>
      createButton(texts.hardwareHint(name, texts.states[target]), () => this.state.changeHardware(name, target), "tool", texts.states[target]),
    );
    return this.createRow(name, state, plugin, commands, buttons);
  }

  private createRow(name: string, state: string, kind: string, interfaces: readonly string[], buttons: readonly HTMLElement[]): HTMLElement {
    const texts = strings.monitor.controllers;
    const problem = this.state.problems.get(name);
    const stateText = state in texts.states ? texts.states[state as keyof typeof texts.states] : state;
    return h(
      "tr",
      { data: { controller: name, state } },
      h("td", {}, name, problem === undefined ? null : h("div", { class: "wrong", role: "alert" }, problem)),
      h("td", { class: `controller-state ${state.replace(" ", "-")}` }, stateText),
      h("td", {}, ...buttons),
      h("td", { class: "note" }, kind),
      h("td", { class: "note controller-interfaces", title: interfaces.join("\n") }, interfaces.join(", ")),
    );
  }
}

function createTable(headings: readonly string[], body: HTMLElement): HTMLElement {
  const head = h("thead", {}, h("tr", {}, ...headings.map((text) => h("th", {}, text))));
  return h("table", { class: "topic-table controller-table" }, head, body);
}
