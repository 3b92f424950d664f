import { createButton, h } from "../../dom";
import { createIcon } from "../../icons";
import type { ParametersState } from "../../state/monitor/parameters";
import { strings } from "../../strings";
import { createTextField } from "../../widgets/controls";
import { saveText } from "../../widgets/save-file";
import { onVisibilityChange } from "../../widgets/visibility";
import type { Panel } from "../panel";
import { ParameterLine } from "./parameter-row";

/** The parameters of a node for editing, as in rqt_reconfigure. */
export class ParametersPanel implements Panel {
  readonly id = "parameters";
  readonly icon = "parameters";
  readonly element: HTMLElement;
  private readonly nodeList = h("ul", { class: "node-list", role: "listbox", aria: { label: strings.monitor.parameters.nodes } });
  private readonly rows = h("div", { class: "parameter-rows" });
  private readonly note = h("p", { class: "empty" });
  private readonly dumpButton: HTMLButtonElement;
  private readonly lines = new Map<string, ParameterLine>();
  private shownNode: string | null = null;
  private filter = "";

  constructor(private readonly state: ParametersState) {
    const texts = strings.monitor.parameters;
    this.dumpButton = createButton(texts.dumpHint, () => state.dump(), "tool", createIcon("download"), texts.dump);
    const filter = createTextField(strings.monitor.filter, (text) => {
      this.filter = text.trim().toLowerCase();
      this.show();
    });
    const toolbar = h("div", { class: "toolbar" }, filter, h("span", { class: "spacer" }), this.dumpButton);
    const parameterList = h("div", { class: "scroll" }, this.note, this.rows);
    this.element = h("div", { class: "panel monitor" }, toolbar, h("div", { class: "parameters" }, this.nodeList, parameterList));
    this.nodeList.addEventListener("keydown", (event) => this.onKeyDown(event));
    state.nodesChanged.on(() => this.showNodes());
    state.changed.on(() => this.show());
    state.resultArrived.on(({ name, successful, reason }) => this.lines.get(name)?.showResult(successful, reason));
    state.dumpArrived.on(({ file, text, error }) => {
      if (error === null) saveText(file, text, "application/yaml");
      else this.showNote(error);
    });
    onVisibilityChange(this.element, (isVisible) => state.watch(isVisible));
    this.showNodes();
    this.show();
  }

  private showNodes(): void {
    const { nodes, node } = this.state;
    const hasFocus = this.nodeList.contains(document.activeElement);
    const items = nodes.map((name) => {
      const item = h("li", { role: "option", title: name, tabIndex: name === (node ?? nodes[0]) ? 0 : -1 }, name);
      item.setAttribute("aria-selected", String(name === node));
      item.addEventListener("click", () => this.choose(name));
      return item;
    });
    const emptyNote = h("li", { class: "note" }, strings.monitor.parameters.noNodes);
    this.nodeList.replaceChildren(...(items.length > 0 ? items : [emptyNote]));
    if (hasFocus) items[nodes.indexOf(node ?? "")]?.focus();
  }

  private choose(name: string): void {
    this.state.chooseNode(name);
  }

  private onKeyDown(event: KeyboardEvent): void {
    const { nodes } = this.state;
    const items = [...this.nodeList.children] as HTMLElement[];
    const index = items.indexOf(document.activeElement as HTMLElement);
    const nextIndex = event.key === "ArrowDown" ? index + 1 : event.key === "ArrowUp" ? index - 1 : index;
    const name = nodes[nextIndex];
    if (name === undefined || index < 0) return;
    if (nextIndex !== index) {
      this.choose(name);
      (this.nodeList.children[nextIndex] as HTMLElement).focus();
    } else if (event.key === "Enter" || event.key === " ") this.choose(name);
    else return;
    event.preventDefault();
  }

  private show(): void {
    const texts = strings.monitor.parameters;
    const { node, parameters } = this.state;
    this.dumpButton.disabled = node === null;
    if (node !== this.shownNode) {
      this.lines.clear();
      this.shownNode = node;
      this.showNodes();
    }
    const shownParameters = (parameters?.parameters ?? []).filter(({ name }) => name.toLowerCase().includes(this.filter));
    const elements = shownParameters.map((row) => {
      let line = this.lines.get(row.name);
      if (line?.isSameParameter(row) !== true) {
        line = new ParameterLine(row, (name, kind, values) => this.state.set(name, kind, values));
        this.lines.set(row.name, line);
      } else line.show(row);
      return line.element;
    });
    const isUnchanged = elements.length === this.rows.childElementCount && elements.every((element, index) => element === this.rows.children[index]);
    if (!isUnchanged) this.rows.replaceChildren(...elements);
    if (node === null) this.showNote(texts.choose);
    else if (parameters === null) this.showNote(texts.requestingParameters);
    else this.showNote(parameters.error ?? (shownParameters.length === 0 ? texts.none : ""));
  }

  private showNote(text: string): void {
    this.note.textContent = text;
    this.note.hidden = text === "";
  }
}
