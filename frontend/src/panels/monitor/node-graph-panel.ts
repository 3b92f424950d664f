import { createButton, h } from "../../dom";
import { createIcon } from "../../icons";
import { buildGraph, type GraphMode, type GraphOptions, type GraphVertex } from "../../state/monitor/graph-model";
import type { NodeGraphState } from "../../state/monitor/node-graph";
import { strings } from "../../strings";
import { createSelect, createTickBox } from "../../widgets/controls";
import { onVisibilityChange } from "../../widgets/visibility";
import type { Panel } from "../panel";
import { NodeGraphDrawing } from "./node-graph-drawing";

/** The node graph as rqt_graph shows it: publishers, topics and subscribers. */
export class NodeGraphPanel implements Panel {
  readonly id = "graph";
  readonly icon = "graph";
  readonly element: HTMLElement;
  private readonly drawing: NodeGraphDrawing;
  private readonly details = h("div", { class: "graph-details", aria: { live: "polite" } });
  private readonly emptyNote = h("p", { class: "empty" }, strings.monitor.graph.none);
  private readonly options: GraphOptions & { openGroups: Set<string> } = {
    mode: "active",
    showsDebug: false,
    showsTf: true,
    groupsNamespaces: false,
    openGroups: new Set<string>(),
  };
  private chosenId: string | null = null;

  constructor(private readonly state: NodeGraphState) {
    const texts = strings.monitor.graph;
    this.drawing = new NodeGraphDrawing(texts.label, (vertex) => this.choose(vertex));
    const modes: [GraphMode, string][] = [
      ["nodes", texts.modes.nodes],
      ["active", texts.modes.active],
      ["all", texts.modes.all],
    ];
    const modeSelect = createSelect(texts.mode, modes, (value) => {
      this.options.mode = value;
      this.show();
    });
    modeSelect.value = this.options.mode;
    const createOptionBox = (name: "showsDebug" | "showsTf" | "groupsNamespaces", text: string, hint: string): HTMLElement => {
      const label = createTickBox(text, hint, (isTicked) => {
        this.options[name] = isTicked;
        this.options.openGroups.clear();
        this.show();
      });
      label.box.checked = this.options[name];
      return label;
    };
    const toolbar = h(
      "div",
      { class: "toolbar" },
      modeSelect,
      createOptionBox("showsTf", texts.tf, texts.tfHint),
      createOptionBox("showsDebug", texts.debug, texts.debugHint),
      createOptionBox("groupsNamespaces", texts.groups, texts.groupsHint),
      h("span", { class: "spacer" }),
      createButton(texts.fitHint, () => this.drawing.fit(), "tool", createIcon("center"), texts.fit),
    );
    const drawingBox = h("div", { class: "graph-stage" }, this.emptyNote);
    drawingBox.append(this.drawing.element);
    this.element = h("div", { class: "panel monitor" }, toolbar, drawingBox, this.details);
    state.changed.on(() => this.show());
    onVisibilityChange(this.element, (isVisible) => state.watch(isVisible));
    this.show();
  }

  private show(): void {
    const graph = buildGraph(this.state.graph, this.options);
    this.emptyNote.hidden = graph.vertices.length > 0;
    this.drawing.show(graph);
    if (!graph.vertices.some(({ id }) => id === this.chosenId)) this.chosenId = null;
    this.drawing.mark(this.chosenId);
    this.showDetails();
  }

  private choose(vertex: GraphVertex | null): void {
    if (vertex?.kind === "group") {
      this.options.openGroups.add(vertex.label.slice(0, -1));
      this.show();
      return;
    }
    this.chosenId = vertex?.id === this.chosenId ? null : (vertex?.id ?? null);
    this.drawing.mark(this.chosenId);
    this.showDetails();
  }

  private showDetails(): void {
    const texts = strings.monitor.graph;
    const [kind, name] = splitVertexId(this.chosenId);
    const { topics } = this.state.graph;
    const createNameList = (text: string, names: readonly string[]): HTMLElement | null =>
      names.length === 0
        ? null
        : h("div", { class: "graph-list" }, h("span", { class: "note" }, text), h("span", {}, names.join(", ")));
    if (kind === "node") {
      const publishes = topics.filter((topic) => topic.publishers.includes(name)).map((topic) => topic.name);
      const subscribes = topics.filter((topic) => topic.subscribers.includes(name)).map((topic) => topic.name);
      this.showInDetails(h("strong", {}, name), createNameList(texts.publishes, publishes), createNameList(texts.subscribes, subscribes));
    } else if (kind === "topic") {
      const topic = topics.find((candidate) => candidate.name === name);
      const types = h("code", { class: "code" }, topic?.types.join(", ") ?? "");
      const title = h("strong", {}, name, " ", types);
      const nameLists = [
        createNameList(texts.publishedBy, topic?.publishers ?? []),
        createNameList(texts.subscribedBy, topic?.subscribers ?? []),
      ] as const;
      this.showInDetails(title, ...nameLists);
    } else this.showInDetails(h("span", { class: "note" }, texts.hint));
  }

  private showInDetails(...children: readonly (HTMLElement | null)[]): void {
    const closeGroupsButton = createButton(
      strings.monitor.graph.closeGroups,
      () => {
        this.options.openGroups.clear();
        this.show();
      },
      "tool",
      strings.monitor.graph.closeGroups,
    );
    const closeButton = this.options.openGroups.size > 0 ? closeGroupsButton : null;
    this.details.replaceChildren(...[...children, closeButton].filter((child) => child !== null));
  }
}

function splitVertexId(id: string | null): [string, string] {
  const colon = id?.indexOf(":") ?? -1;
  return id === null ? ["", ""] : [id.slice(0, colon), id.slice(colon + 1)];
}
