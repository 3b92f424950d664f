import { createButton, coalesce, h } from "../../dom";
import { createIcon } from "../../icons";
import type { DescriptionModel, ElementName } from "../../state/description-model";
import { isSameElement } from "../../state/element-focus";
import { listVisibleRows, LinkTreeState, type TreeRow } from "../../state/link-tree";
import type { Session } from "../../state/session";
import { strings } from "../../strings";
import { VirtualRows } from "../../widgets/virtual-rows";
import { holdWhileVisible } from "../../widgets/visibility";
import type { Panel } from "../panel";
import { getCurrentModel } from "./current-model";

const ROW_HEIGHT_PX = 23;
const FLASH_MS = 1600;

/** The kinematic tree: each link with the joint that moves it. */
export class LinksPanel implements Panel {
  readonly id = "links";
  readonly icon = "tree";
  readonly element: HTMLElement;
  private readonly rows = new VirtualRows("link-rows", ROW_HEIGHT_PX, (index) => this.createRow(index));
  private readonly search = h("input", { class: "field filter" });
  private readonly emptyNote = h("p", { class: "empty" }, strings.description.waiting);
  private readonly count = h("span", { class: "toolbar-label" });
  private readonly tree = new LinkTreeState();
  private shownRows: TreeRow[] = [];
  private model: DescriptionModel | undefined;
  private flashingNames = new Set<string>();

  constructor(private readonly session: Session) {
    const texts = strings.description;
    this.tree.preserveIn(session.pageMemory);
    this.search.type = "search";
    this.search.placeholder = texts.search;
    this.search.setAttribute("aria-label", texts.search);
    this.search.addEventListener("input", () => this.update());
    const toolbar = h(
      "div",
      { class: "toolbar" },
      this.count,
      h("span", { class: "spacer" }),
      createButton(texts.expandAll, () => this.setAllFolded(false), "tool bare", createIcon("expand")),
      createButton(texts.collapseAll, () => this.setAllFolded(true), "tool bare", createIcon("collapse")),
    );
    this.rows.element.setAttribute("role", "tree");
    this.rows.element.setAttribute("aria-label", texts.linksLabel);
    this.rows.element.addEventListener("keydown", (event) => this.onKeyDown(event));
    this.rows.element.addEventListener("pointerleave", () => session.focus.setHovered(null));
    this.element = h("div", { class: "panel" }, toolbar, this.search, this.emptyNote, this.rows.element);
    const update = coalesce(() => this.update());
    const { description, focus } = session;
    holdWhileVisible(this.element, () => description.hold(), update);
    description.arrived.on(update);
    description.findingsArrived.on(update);
    session.robotChanged.on(update);
    focus.changed.on(coalesce(() => this.showFocus()));
    description.edited.on(({ links, joints }) => this.flash([...links, ...joints]));
    this.update();
  }

  private update(): void {
    this.model = getCurrentModel(this.session);
    const { model } = this;
    this.emptyNote.hidden = model !== undefined;
    this.rows.element.hidden = this.search.hidden = model === undefined;
    if (!model) return;
    const { links, joints } = model;
    this.count.textContent = strings.description.count(links.size, joints.size);
    this.shownRows = listVisibleRows(model, this.tree, this.search.value);
    const maxDepth = this.shownRows.reduce((maximum, { depth }) => Math.max(maximum, depth), 1);
    this.rows.element.style.setProperty("--deepest", String(maxDepth));
    this.rows.refresh(this.shownRows.length);
  }

  /** Unfolds and reveals the row of the newly selected element. */
  private showFocus(): void {
    const link = this.getFocusedLink();
    if (this.model && link !== undefined && this.search.value === "") this.tree.reveal(this.model, link);
    this.update();
    const index = this.shownRows.findIndex((row) => row.link.name === link);
    if (index >= 0) this.rows.reveal(index);
  }

  private getFocusedLink(): string | undefined {
    const { current } = this.session.focus;
    return current && current.display === this.model?.display ? this.session.focus.linkOf(current) : undefined;
  }

  private createRow(index: number): HTMLElement {
    const row = this.shownRows[index];
    const model = this.model;
    if (!row || !model) return h("div");
    const { link, joint, depth, isFolded } = row;
    const focus = this.session.focus.current;
    const createElementName = (kind: "link" | "joint", elementName: string): ElementName => ({ display: model.display, kind, name: elementName });
    const linkElement = createElementName("link", link.name);
    const foldToggle = h("span", { class: row.hasChildren ? "twist" : "twist leaf" }, createIcon("chevron"));
    foldToggle.addEventListener("click", (event) => {
      event.stopPropagation();
      this.toggle(index);
    });
    const findings = this.session.description.findingsOf(model.display).filter((finding) => finding.link === link.name);
    const element = h(
      "div",
      { class: "link-row", role: "treeitem", data: { link: link.name } },
      foldToggle,
      createIcon("cube"),
      h("span", { class: "link-name", title: link.name }, link.name),
      findings.length > 0 ? createWarningBadge(findings.map((finding) => finding.message)) : null,
      h("span", { class: "spacer" }),
      joint ? this.createJointName(createElementName("joint", joint.name), joint.kind) : null,
    );
    element.style.setProperty("--depth", String(depth));
    element.id = `link-row-${index}`;
    element.setAttribute("aria-level", String(depth + 1));
    element.setAttribute("aria-selected", String(isSameElement(focus, linkElement)));
    if (row.hasChildren) element.setAttribute("aria-expanded", String(!isFolded));
    element.classList.toggle("selected", link.name === this.getFocusedLink());
    element.classList.toggle("flash", this.flashingNames.has(link.name) || (joint !== null && this.flashingNames.has(joint.name)));
    element.addEventListener("click", () => this.select(index, linkElement));
    element.addEventListener("pointerenter", () => this.session.focus.setHovered(linkElement));
    return element;
  }

  private createJointName(joint: ElementName, kind: keyof typeof strings.description.kinds): HTMLElement {
    const element = h(
      "span",
      { class: `joint-of ${kind}`, title: `${joint.name} (${strings.description.kinds[kind]})`, data: { joint: joint.name } },
      createIcon("joints"),
      h("span", {}, joint.name),
    );
    element.classList.toggle("selected", isSameElement(this.session.focus.current, joint));
    element.addEventListener("click", (event) => {
      event.stopPropagation();
      this.session.focus.select(joint);
    });
    element.addEventListener("pointerenter", () => this.session.focus.setHovered(joint));
    return element;
  }

  private select(index: number, element: ElementName): void {
    this.rows.element.setAttribute("aria-activedescendant", `link-row-${index}`);
    this.session.focus.select(element);
  }

  private toggle(index: number): void {
    const row = this.shownRows[index];
    if (row?.hasChildren) this.tree.toggle(row.link.name);
    this.update();
  }

  private setAllFolded(isFolded: boolean): void {
    if (this.model) this.tree.setAllFolded(this.model, isFolded);
    this.update();
  }

  private onKeyDown(event: KeyboardEvent): void {
    const link = this.getFocusedLink();
    const index = this.shownRows.findIndex((row) => row.link.name === link);
    const row = this.shownRows[index];
    const selectRow = (index: number): void => {
      const targetRow = this.shownRows[Math.min(Math.max(0, index), this.shownRows.length - 1)];
      if (targetRow && this.model) this.select(index, { display: this.model.display, kind: "link", name: targetRow.link.name });
    };
    if (event.key === "ArrowDown") selectRow(index + 1);
    else if (event.key === "ArrowUp") selectRow(index - 1);
    else if (event.key === "Home") selectRow(0);
    else if (event.key === "End") selectRow(this.shownRows.length - 1);
    else if (event.key === "ArrowRight" && row?.hasChildren && row.isFolded) this.toggle(index);
    else if (event.key === "ArrowRight") selectRow(index + 1);
    else if (event.key === "ArrowLeft" && row?.hasChildren && !row.isFolded) this.toggle(index);
    else if (event.key === "ArrowLeft" && row?.joint) selectRow(this.shownRows.findIndex((candidate) => candidate.link.name === row.joint?.parent));
    else if (event.key === "Enter" && row?.joint && this.model) {
      // Switch from a link to its joint, or back.
      const kind = this.session.focus.current?.kind === "joint" ? "link" : "joint";
      const name = kind === "link" ? row.link.name : row.joint.name;
      this.session.focus.select({ display: this.model.display, kind, name });
    } else return;
    event.preventDefault();
    event.stopPropagation();
  }

  private flash(names: readonly string[]): void {
    this.flashingNames = new Set(names);
    this.update();
    setTimeout(() => {
      this.flashingNames.clear();
      this.update();
    }, FLASH_MS);
  }
}

function createWarningBadge(messages: readonly string[]): HTMLElement {
  return h("span", { class: "level-warn", title: messages.join("\n") }, createIcon("warn"));
}
