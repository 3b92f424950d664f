import { createButton, coalesce, h } from "../../dom";
import { createIcon } from "../../icons";
import type { DescriptionModel, ElementName } from "../../state/description-model";
import { layOutDiagram, type Diagram, type DiagramNode } from "../../state/diagram-layout";
import { isSameElement } from "../../state/element-focus";
import type { Session } from "../../state/session";
import { strings } from "../../strings";
import { PanZoom } from "../../widgets/pan-zoom";
import { holdWhileVisible } from "../../widgets/visibility";
import type { Panel } from "../panel";
import { getCurrentModel } from "./current-model";

const SVG_NAMESPACE = "http://www.w3.org/2000/svg";
const FONT = "12px Inter, 'Segoe UI', 'Noto Sans', sans-serif";
const ORIGIN_LINE_PX = 13;
/** Font size of the smallest texts, the origins. */
const MIN_TEXT_PX = 11;
const FLASH_MS = 1600;

/** The structure of the robot, drawn as by urdf_to_graphviz. */
export class DiagramPanel implements Panel {
  readonly id = "diagram";
  readonly icon = "diagram";
  readonly element: HTMLElement;
  private readonly canvas = h("div", { class: "diagram", tabIndex: 0, role: "group", aria: { label: strings.description.diagram.label } });
  private readonly svg = createSvg("svg", {});
  private readonly drawing = createSvg("g", {});
  private readonly emptyNote = h("p", { class: "empty" }, strings.description.waiting);
  private readonly panZoom: PanZoom;
  private readonly nodes = new Map<string, SVGGElement>();
  private readonly measure = createTextMeasure();
  private showsOrigins = true;
  private model: DescriptionModel | undefined;
  private diagram: Diagram | null = null;
  private isPlaced = false;

  constructor(private readonly session: Session) {
    const texts = strings.description.diagram;
    this.svg.append(this.drawing);
    this.canvas.append(this.svg);
    this.panZoom = new PanZoom(
      this.canvas,
      (x, y, scale) => this.drawing.setAttribute("transform", `translate(${x} ${y}) scale(${scale})`),
      () => this.fit(),
    );
    const originsButton = createButton(texts.originsHint, () => this.toggleOrigins(originsButton), "tool on", texts.origins);
    originsButton.setAttribute("aria-pressed", "true");
    const toolbar = h(
      "div",
      { class: "toolbar" },
      createButton(texts.fitHint, () => this.fit(), "tool", createIcon("fit"), texts.fit),
      createButton(texts.zoomIn, () => this.panZoom.zoomBy(1.25), "tool bare", createIcon("plus")),
      createButton(texts.zoomOut, () => this.panZoom.zoomBy(0.8), "tool bare", createIcon("minus")),
      h("span", { class: "spacer" }),
      originsButton,
    );
    this.element = h("div", { class: "panel" }, toolbar, this.emptyNote, this.canvas);
    const { description, focus } = session;
    const update = coalesce(() => this.update());
    holdWhileVisible(this.element, () => description.hold(), update);
    description.arrived.on(update);
    session.robotChanged.on(update);
    focus.changed.on(coalesce(() => this.showFocus()));
    description.edited.on(({ links, joints }) => this.flash(links, joints));
    this.update();
  }

  /** Returns the counts and sizes that tests check. */
  inspect(): object {
    const { nodes = [], width = 0, height = 0 } = this.diagram ?? {};
    return {
      links: nodes.filter(({ element }) => element.kind === "link").length,
      joints: nodes.filter(({ element }) => element.kind === "joint").length,
      width,
      height,
      scale: this.panZoom.scale,
    };
  }

  private update(): void {
    const model = getCurrentModel(this.session);
    this.emptyNote.hidden = model !== undefined;
    this.canvas.hidden = model === undefined;
    if (!model) return;
    if (model !== this.model) {
      this.isPlaced &&= this.model?.display === model.display && this.model.links.size === model.links.size;
      this.model = model;
      this.draw(model);
    }
    if (this.isPlaced || this.canvas.clientWidth === 0) return;
    this.isPlaced = true;
    this.placeDrawing();
    this.showFocus();
  }

  private draw(model: DescriptionModel): void {
    this.diagram = layOutDiagram(model, this.showsOrigins, this.measure);
    this.nodes.clear();
    const edges = createSvg("g", { class: "edges" });
    const shapes = createSvg("g", {});
    for (const node of this.diagram.nodes) {
      const { parent } = node;
      if (parent) {
        edges.append(createSvg("path", { d: createEdgePath(parent, node), class: "edge" }), createSvg("path", { d: createArrowHeadPath(node), class: "edge-head" }));
      }
      const shape = this.createNode(node, model);
      this.nodes.set(createNodeKey(node.element), shape);
      shapes.append(shape);
    }
    this.drawing.replaceChildren(edges, shapes);
  }

  private createNode(node: DiagramNode, model: DescriptionModel): SVGGElement {
    const { element, x, y, width, height, origin } = node;
    const kind = element.kind === "joint" ? (model.joints.get(element.name)?.kind ?? "") : "";
    const group = createSvg("g", { class: `node ${element.kind} ${kind}`, transform: `translate(${x} ${y})` });
    group.dataset[element.kind] = element.name;
    origin.forEach((text, i) => {
      const baseline = -height / 2 - 12 - (origin.length - 1 - i) * ORIGIN_LINE_PX;
      group.append(createLabel(text, baseline, "origin"));
    });
    const shape =
      element.kind === "link"
        ? createSvg("rect", { x: -width / 2, y: -height / 2, width, height, rx: 3 })
        : createSvg("ellipse", { rx: width / 2, ry: height / 2 });
    group.append(shape, createLabel(element.name, 0, "name"));
    group.addEventListener("click", () => {
      if (!this.panZoom.wasDragged) this.session.focus.select(element);
    });
    group.addEventListener("pointerenter", () => this.session.focus.setHovered(element));
    group.addEventListener("pointerleave", () => this.session.focus.setHovered(null));
    return group;
  }

  private showFocus(): void {
    const { current } = this.session.focus;
    for (const element of this.drawing.querySelectorAll(".node.selected")) element.classList.remove("selected");
    if (!current) return;
    this.nodes.get(createNodeKey(current))?.classList.add("selected");
    const node = this.diagram?.nodes.find(({ element }) => isSameElement(element, current));
    if (node && !this.canvas.matches(":hover")) this.panZoom.reveal(node.x, node.y);
  }

  private fit(): void {
    if (this.diagram && this.canvas.clientWidth > 0) this.panZoom.fitImage(this.diagram.width, this.diagram.height);
  }

  /** Scrolls to the selected element, or else the root, at a legible size. */
  private placeDrawing(): void {
    const { diagram } = this;
    if (!diagram || this.canvas.clientWidth === 0) return;
    const { current } = this.session.focus;
    const node = (current && diagram.nodes.find(({ element }) => isSameElement(element, current))) ?? diagram.nodes.find(({ parent }) => !parent);
    this.panZoom.showLegibly(diagram.width, diagram.height, MIN_TEXT_PX, [node?.x ?? 0, node?.y ?? 0]);
  }

  private toggleOrigins(toggle: HTMLElement): void {
    this.showsOrigins = !this.showsOrigins;
    toggle.classList.toggle("on", this.showsOrigins);
    toggle.setAttribute("aria-pressed", String(this.showsOrigins));
    if (this.model) this.draw(this.model);
    this.placeDrawing();
    this.showFocus();
  }

  private flash(links: readonly string[], joints: readonly string[]): void {
    // Wait for the new diagram, which arrives after the request that the same change caused.
    setTimeout(() => {
      const names = [...links.map((name) => `link ${name}`), ...joints.map((name) => `joint ${name}`)];
      for (const node of names.flatMap((name) => this.nodes.get(name) ?? [])) {
        node.classList.add("flash");
        setTimeout(() => node.classList.remove("flash"), FLASH_MS);
      }
    }, 200);
  }
}

function createNodeKey({ kind, name }: ElementName): string {
  return `${kind} ${name}`;
}

/** Returns the path from the lower end of one node to the upper end of another. */
function createEdgePath(parent: DiagramNode, child: DiagramNode): string {
  const [top, bottom] = [parent.y + parent.height / 2, child.y - child.height / 2];
  const bend = Math.min(14, (bottom - top) / 2);
  return `M${parent.x} ${top}C${parent.x} ${top + bend} ${child.x} ${top} ${child.x} ${top + 2 * bend}V${bottom - 5}`;
}

function createArrowHeadPath({ x, y, height }: DiagramNode): string {
  return `M${x - 3.5} ${y - height / 2 - 7}h7l-3.5 7z`;
}

function createLabel(text: string, y: number, className: string): SVGTextElement {
  const element = createSvg("text", { y, class: className });
  element.textContent = text;
  return element;
}

function createSvg<K extends keyof SVGElementTagNameMap>(
  tag: K,
  attributes: Readonly<Record<string, string | number>>,
): SVGElementTagNameMap[K] {
  const element = document.createElementNS(SVG_NAMESPACE, tag);
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, String(value));
  return element;
}

/** Returns a function that measures texts in the diagram's font, each text once. */
function createTextMeasure(): (text: string) => number {
  const context = document.createElement("canvas").getContext("2d");
  const widths = new Map<string, number>();
  if (context) context.font = FONT;
  return (text) => {
    let width = widths.get(text);
    if (width === undefined) widths.set(text, (width = context?.measureText(text).width ?? text.length * 7));
    return width;
  };
}
