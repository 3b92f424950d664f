import { h } from "../../dom";
import { layOutLayers, type PlacedBox, type Route } from "../../state/monitor/graph-layout";
import type { DrawnGraph, GraphVertex } from "../../state/monitor/graph-model";
import { PanZoom } from "../../widgets/pan-zoom";

const SVG_NAMESPACE = "http://www.w3.org/2000/svg";
const BOX_HEIGHT_PX = 28;
const PADDING_PX = 24;
const TEXT_PX = 12;

/** The graph as SVG; it can be dragged, zoomed with the wheel, and one vertex chosen by mouse or keyboard. */
export class NodeGraphDrawing {
  readonly element = h("div", { class: "graph-drawing", tabIndex: 0, role: "group" });
  private readonly drawing = createSvgElement("g", {});
  private readonly measureContext = document.createElement("canvas").getContext("2d");
  private graph: DrawnGraph = { vertices: [], edges: [] };
  private size: readonly [number, number] = [1, 1];
  private readonly panZoom: PanZoom;
  /**
   * The part of the graph in view, which is restored when the graph or the panel changes: a legible part, the whole
   * graph, or what the user moved to.
   */
  private viewMode: "legible" | "all" | "chosen" = "legible";
  private boxes: ReadonlyMap<string, PlacedBox> = new Map();
  private markedId: string | null = null;

  constructor(
    label: string,
    private readonly onVertexChosen: (vertex: GraphVertex | null) => void,
  ) {
    this.element.setAttribute("aria-label", label);
    const svg = createSvgElement("svg", {});
    svg.append(createArrowHeads(), this.drawing);
    this.element.append(svg);
    this.panZoom = new PanZoom(this.element, (x, y, scale) => this.onMoved(x, y, scale), () => this.fit());
    this.element.addEventListener("click", (event) => this.onClick(event.target as Element));
    this.element.addEventListener("keydown", (event) => {
      if (event.key === "Escape") onVertexChosen(null);
    });
    new ResizeObserver(() => {
      this.placeDrawing();
    }).observe(this.element);
  }

  /** Draws a graph; keeps the view if the user has moved it. */
  show(graph: DrawnGraph): void {
    this.graph = graph;
    if (this.measureContext) this.measureContext.font = `12px ${getComputedStyle(document.body).fontFamily}`;
    const boxes = graph.vertices.map((vertex) => ({ id: vertex.id, width: this.computeWidth(vertex), height: BOX_HEIGHT_PX }));
    const layout = layOutLayers(boxes, graph.edges);
    this.size = [layout.width, layout.height];
    this.boxes = layout.boxes;
    const vertices = new Map(graph.vertices.map((vertex) => [vertex.id, vertex]));
    const edges = layout.routes.map((route) => drawRoute(route, this.formatTopics(route)));
    const shapes = [...layout.boxes.values()].map((box) => this.drawBox(box, vertices.get(box.id)));
    this.drawing.replaceChildren(...edges, ...shapes);
    this.placeDrawing();
  }

  /** Marks a vertex, its neighbors and the edges between them; null marks nothing. */
  mark(id: string | null): void {
    this.markedId = id;
    const { edges } = this.graph;
    const neighbors = new Set(edges.flatMap(({ source, target }) => (source === id ? [target] : target === id ? [source] : [])));
    this.element.classList.toggle("marked", id !== null);
    for (const shape of this.drawing.querySelectorAll<SVGElement>("[data-id]")) {
      const shapeId = shape.dataset["id"] ?? "";
      shape.classList.toggle("chosen", shapeId === id);
      shape.classList.toggle("near", neighbors.has(shapeId));
      shape.setAttribute("aria-pressed", String(shapeId === id));
    }
    for (const edge of this.drawing.querySelectorAll<SVGElement>("[data-from]")) {
      edge.classList.toggle("near", id !== null && (edge.dataset["from"] === id || edge.dataset["to"] === id));
    }
  }

  /** Fits the whole graph into the panel. */
  fit(): void {
    if (this.element.clientWidth === 0) return;
    this.panZoom.fitImage(...this.size);
    this.viewMode = "all";
  }

  private placeDrawing(): void {
    if (this.viewMode === "all") this.fit();
    if (this.viewMode !== "legible" || this.element.clientWidth === 0) return;
    const box = this.boxes.get(this.markedId ?? "") ?? this.findBusiestBox();
    this.panZoom.showLegibly(...this.size, TEXT_PX, [box?.x ?? 0, box?.y ?? 0]);
    this.viewMode = "legible";
  }

  /** Returns the box of the vertex with the most edges. */
  private findBusiestBox(): PlacedBox | undefined {
    const degrees = new Map<string, number>();
    for (const id of this.graph.edges.flatMap(({ source, target }) => [source, target])) degrees.set(id, (degrees.get(id) ?? 0) + 1);
    const [busiestVertex] = [...degrees].sort(([, a], [, b]) => b - a);
    return this.boxes.get(busiestVertex?.[0] ?? "");
  }

  private drawBox(box: PlacedBox, vertex: GraphVertex | undefined): SVGElement {
    const shape = createSvgElement("g", {
      class: "vertex",
      "data-kind": vertex?.kind ?? "node",
      transform: `translate(${box.x - box.width / 2} ${box.y - box.height / 2})`,
      tabindex: "0",
      role: "button",
      "data-id": box.id,
    });
    const cornerRadius = vertex?.kind === "topic" || vertex?.kind === "action" ? "3" : String(box.height / 2);
    const text = createSvgElement("text", { x: String(box.width / 2), y: String(box.height / 2), dy: "0.34em" });
    text.textContent = formatLabel(vertex);
    shape.append(createSvgElement("rect", { width: String(box.width), height: String(box.height), rx: cornerRadius }), text);
    shape.addEventListener("keydown", (event) => {
      if (event.key !== "Enter" && event.key !== " ") return;
      event.preventDefault();
      event.stopPropagation();
      this.onVertexChosen(vertex ?? null);
    });
    return shape;
  }

  private formatTopics({ source, target }: Route): string {
    const edge = this.graph.edges.find((candidate) => candidate.source === source && candidate.target === target);
    return edge?.topics.join("\n") ?? "";
  }

  private computeWidth(vertex: GraphVertex): number {
    const text = formatLabel(vertex);
    return Math.ceil(this.measureContext?.measureText(text).width ?? text.length * 7) + PADDING_PX;
  }

  private onClick(target: Element): void {
    if (this.panZoom.wasDragged) return;
    const id = target.closest<SVGElement>("[data-id]")?.dataset["id"];
    this.onVertexChosen(this.graph.vertices.find((vertex) => vertex.id === id) ?? null);
  }

  private onMoved(x: number, y: number, scale: number): void {
    this.viewMode = "chosen";
    this.drawing.setAttribute("transform", `translate(${x} ${y}) scale(${scale})`);
  }
}

function formatLabel(vertex: GraphVertex | undefined): string {
  if (!vertex) return "";
  return vertex.kind === "group" ? `${vertex.label} (${vertex.count})` : vertex.label;
}

function drawRoute({ source, target, points }: Route, topics: string): SVGElement {
  const [firstPoint, ...otherPoints] = points;
  let [x, y] = firstPoint ?? [0, 0];
  let path = `M${x} ${y}`;
  for (const [nextX, nextY] of otherPoints) {
    const bend = (nextX - x) / 2;
    path += `C${x + bend} ${y} ${nextX - bend} ${nextY} ${nextX} ${nextY}`;
    [x, y] = [nextX, nextY];
  }
  const edge = createSvgElement("path", { class: "edge", d: path, "data-from": source, "data-to": target, "marker-end": "url(#graph-arrow)" });
  if (topics !== "") {
    const title = createSvgElement("title", {});
    title.textContent = topics;
    edge.append(title);
  }
  return edge;
}

function createArrowHeads(): SVGElement {
  const marker = createSvgElement("marker", {
    id: "graph-arrow",
    viewBox: "0 0 8 8",
    refX: "7.5",
    refY: "4",
    markerWidth: "7",
    markerHeight: "7",
    orient: "auto",
  });
  marker.append(createSvgElement("path", { d: "M0 1L8 4L0 7z", class: "arrow-head" }));
  const defs = createSvgElement("defs", {});
  defs.append(marker);
  return defs;
}

function createSvgElement<K extends keyof SVGElementTagNameMap>(tag: K, attributes: Readonly<Record<string, string>>): SVGElementTagNameMap[K] {
  const element = document.createElementNS(SVG_NAMESPACE, tag);
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
  return element;
}
