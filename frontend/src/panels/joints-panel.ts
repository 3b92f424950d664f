import { button, h } from "../dom";
import { icon } from "../icons";
import type { Session } from "../state/session";
import { strings } from "../strings";
import { JointRow, type AngleUnit } from "./joint-row";
import type { Panel } from "./panel";

const UNIT_KEY = "linkwright.angle-unit";
/** From this many joints on a filter helps. */
const FILTER_FROM = 10;

/** joint_state_publisher_gui's sliders. */
export class JointsPanel implements Panel {
  readonly id = "joints";
  readonly icon = "joints";
  readonly element: HTMLElement;
  private readonly list = h("div", { class: "joints" });
  private readonly filter = h("input", { class: "field filter" });
  private readonly unit: HTMLElement;
  private rows: JointRow[] = [];
  private angles: AngleUnit = localStorage.getItem(UNIT_KEY) === "deg" ? "deg" : "rad";
  private readonly moves = new Map<string, number>();

  constructor(private readonly session: Session) {
    const words = strings.joints;
    const send = session.connection;
    this.unit = h("div", { class: "segmented", title: words.unitHint, role: "group", aria: { label: words.unitHint } });
    this.filter.placeholder = words.filter;
    this.filter.setAttribute("aria-label", words.filter);
    this.filter.addEventListener("input", () => this.applyFilter());
    const bar = h(
      "div",
      { class: "toolbar" },
      button(words.randomizeHint, () => send.send({ type: "randomize_joints" }), "tool", icon("shuffle"), words.randomize),
      button(words.centerHint, () => send.send({ type: "center_joints" }), "tool", icon("center"), words.center),
      h("span", { class: "spacer" }),
      this.unit,
    );
    this.element = h("div", { class: "panel" }, bar, this.filter, this.list);
    session.joints.controlsChanged.on(() => this.build());
    session.joints.positionsChanged.on(() => this.update());
    this.showUnit();
    this.build();
  }

  private build(): void {
    const controls = this.session.joints.controls ?? [];
    this.rows = controls.map((joint) => new JointRow(joint, this.angles, (position) => this.move(joint.name, position)));
    this.list.replaceChildren(...this.rows.map((row) => row.element));
    if (this.rows.length === 0) this.list.append(h("p", { class: "empty" }, strings.joints.none));
    this.filter.hidden = this.rows.length < FILTER_FROM;
    if (this.filter.hidden) this.filter.value = "";
    this.applyFilter();
    this.update();
  }

  private update(): void {
    const { positions } = this.session.joints;
    for (const row of this.rows) {
      const position = positions[row.joint.name];
      if (position !== undefined) row.setPosition(position);
    }
  }

  /** At most one message a joint and animation frame, the first one at once. */
  private move(name: string, position: number): void {
    const send = (value: number): void => {
      this.session.connection.send({ type: "set_joint", name, position: value });
    };
    if (this.moves.has(name)) {
      this.moves.set(name, position);
      return;
    }
    send(position);
    this.moves.set(name, position);
    requestAnimationFrame(() => {
      const last = this.moves.get(name);
      this.moves.delete(name);
      if (last !== undefined && last !== position) send(last);
    });
  }

  private applyFilter(): void {
    const wanted = this.filter.value.trim().toLowerCase();
    for (const row of this.rows) row.element.hidden = !row.joint.name.toLowerCase().includes(wanted);
  }

  private showUnit(): void {
    const words = strings.joints;
    const choice = (unit: AngleUnit, label: string): HTMLElement => {
      const element = button(label, () => this.setAngles(unit), unit === this.angles ? "on" : "", label);
      element.setAttribute("aria-pressed", String(unit === this.angles));
      return element;
    };
    this.unit.replaceChildren(choice("rad", words.radians), choice("deg", words.degrees));
  }

  private setAngles(unit: AngleUnit): void {
    this.angles = unit;
    localStorage.setItem(UNIT_KEY, unit);
    for (const row of this.rows) row.setAngles(unit);
    this.showUnit();
  }
}
