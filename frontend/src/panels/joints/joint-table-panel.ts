import { createButton, coalesce, h } from "../../dom";
import type { JointDetails } from "../../protocol";
import type { DescriptionModel } from "../../state/description-model";
import { formatJointCells, COLUMNS, sortJoints, type Column } from "../../state/joint-table";
import type { Session } from "../../state/session";
import { strings } from "../../strings";
import { UnitSwitch } from "../../widgets/unit-switch";
import { holdWhileVisible } from "../../widgets/visibility";
import { getCurrentModel } from "../description/current-model";
import type { Panel } from "../panel";

/** A table of all joints of the robot with their properties in the description. */
export class JointTablePanel implements Panel {
  readonly id = "joint-table";
  readonly icon = "table";
  readonly element: HTMLElement;
  private readonly headRow = h("tr", {});
  private readonly body = h("tbody", {});
  private readonly empty = h("p", { class: "empty" }, strings.description.waiting);
  private readonly tableBox: HTMLElement;
  private readonly count = h("span", { class: "toolbar-label" });
  private readonly rows = new Map<string, HTMLElement>();
  private sorting: { column: Column; isDescending: boolean } | null = null;
  private model: DescriptionModel | undefined;

  constructor(private readonly session: Session) {
    const table = h("table", { class: "joint-table" }, h("thead", {}, this.headRow), this.body);
    this.tableBox = h("div", { class: "table-box" }, table);
    const units = new UnitSwitch(session.angleUnits);
    const bar = h("div", { class: "toolbar" }, this.count, h("span", { class: "spacer" }), units.element);
    this.element = h("div", { class: "panel" }, bar, this.empty, this.tableBox);
    const { description, focus, angleUnits } = session;
    const update = coalesce(() => this.update());
    holdWhileVisible(this.element, () => description.hold(), update);
    description.arrived.on(update);
    session.robotChanged.on(update);
    angleUnits.changed.on(update);
    focus.changed.on(coalesce(() => this.markCurrent(true)));
    this.update();
  }

  private update(): void {
    this.model = getCurrentModel(this.session);
    const joints = this.model?.description.joints ?? [];
    this.empty.hidden = this.model !== undefined;
    this.tableBox.hidden = this.model === undefined;
    this.count.textContent = this.model ? strings.description.count(this.model.links.size, joints.length) : "";
    this.headRow.replaceChildren(...COLUMNS.map((column) => this.createHeading(column)));
    this.rows.clear();
    const { sorting } = this;
    const sortedJoints = sorting ? sortJoints(joints, sorting.column, sorting.isDescending) : joints;
    this.body.replaceChildren(...sortedJoints.map((joint) => this.createRow(joint)));
    this.markCurrent(false);
  }

  private createHeading(column: Column): HTMLElement {
    const texts = strings.description.table;
    const isSorted = this.sorting?.column === column;
    const sign = isSorted ? (this.sorting?.isDescending ? " ▾" : " ▴") : "";
    const cell = h("th", {}, createButton(texts.hints[column], () => this.sortBy(column), "", texts[column] + sign));
    cell.scope = "col";
    cell.setAttribute("aria-sort", isSorted ? (this.sorting?.isDescending ? "descending" : "ascending") : "none");
    return cell;
  }

  private createRow(joint: JointDetails): HTMLElement {
    const texts = formatJointCells(joint, this.session.angleUnits, strings.description);
    const row = h(
      "tr",
      { tabIndex: 0, data: { joint: joint.name } },
      ...COLUMNS.map((column) => h("td", { class: `column-${column}`, title: texts[column] }, texts[column])),
    );
    const element = { display: this.model?.display ?? "", kind: "joint" as const, name: joint.name };
    row.addEventListener("click", () => this.session.focus.select(element));
    row.addEventListener("pointerenter", () => this.session.focus.setHovered(element));
    row.addEventListener("pointerleave", () => this.session.focus.setHovered(null));
    row.addEventListener("keydown", (event) => {
      const neighbor = { ArrowDown: row.nextElementSibling, ArrowUp: row.previousElementSibling }[event.key];
      if (neighbor instanceof HTMLElement) neighbor.focus();
      else if (event.key === "Enter" || event.key === " ") this.session.focus.select(element);
      else return;
      event.preventDefault();
    });
    this.rows.set(joint.name, row);
    return row;
  }

  /** Cycles through ascending order, descending order, and the order of the file. */
  private sortBy(column: Column): void {
    if (this.sorting?.column !== column) this.sorting = { column, isDescending: false };
    else this.sorting = this.sorting.isDescending ? null : { column, isDescending: true };
    this.update();
  }

  private markCurrent(scrollsIntoView: boolean): void {
    const { current } = this.session.focus;
    for (const [name, row] of this.rows) {
      const isCurrent = current?.display === this.model?.display && current?.kind === "joint" && current.name === name;
      row.classList.toggle("selected", isCurrent);
      row.setAttribute("aria-selected", String(isCurrent));
      if (isCurrent && scrollsIntoView && !row.matches(":hover")) row.scrollIntoView({ block: "nearest" });
    }
  }
}
