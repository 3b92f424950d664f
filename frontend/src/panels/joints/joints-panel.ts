import { h } from "../../dom";
import type { Session } from "../../state/session";
import { strings } from "../../strings";
import type { Panel } from "../panel";
import { createJointBar } from "./joint-bar";
import { JointRow } from "./joint-row";
import { PoseBar } from "./pose-bar";
import { SweepBar } from "./sweep-bar";
import { createTipBar } from "./tip-bar";

/** The minimum number of joints for which the filter is shown. */
const MIN_JOINTS_FOR_FILTER = 10;

/** The sliders of joint_state_publisher_gui, with named poses and a sweep. */
export class JointsPanel implements Panel {
  readonly id = "joints";
  readonly icon = "joints";
  readonly element: HTMLElement;
  private readonly list = h("div", { class: "joints" });
  private readonly filter = h("input", { class: "field filter" });
  private readonly bars: HTMLElement;
  private rows: JointRow[] = [];

  constructor(private readonly session: Session) {
    const texts = strings.joints;
    const { joints, angleUnits } = session;
    this.filter.placeholder = texts.filter;
    this.filter.setAttribute("aria-label", texts.filter);
    this.filter.addEventListener("input", () => this.applyFilter());
    const bar = createJointBar(session);
    this.bars = h("div", { class: "joint-bars" }, new PoseBar(session).element, new SweepBar(joints).element, createTipBar(session));
    this.element = h("div", { class: "panel joints-panel" }, bar, this.bars, this.filter, this.list);
    joints.controlsChanged.on(() => this.build());
    joints.positionsChanged.on(() => this.update());
    angleUnits.changed.on(() => this.rows.forEach((row) => row.showUnit()));
    this.build();
  }

  private build(): void {
    const { joints, angleUnits } = this.session;
    this.rows = (joints.controls ?? []).map(
      (joint) => new JointRow(joint, angleUnits, (position) => joints.move({ [joint.name]: position })),
    );
    this.list.replaceChildren(...this.rows.map((row) => row.element));
    const isEmpty = this.rows.length === 0;
    if (isEmpty) this.list.append(h("p", { class: "empty" }, strings.joints.none));
    this.bars.hidden = isEmpty;
    this.filter.hidden = this.rows.length < MIN_JOINTS_FOR_FILTER;
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

  private applyFilter(): void {
    const query = this.filter.value.trim().toLowerCase();
    for (const row of this.rows) row.element.hidden = !row.joint.name.toLowerCase().includes(query);
  }
}
