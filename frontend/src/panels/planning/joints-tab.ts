import { h } from "../../dom";
import type { MotionPlanningState } from "../../protocol";
import type { AngleUnits } from "../../state/angle-unit";
import type { MotionPlanning } from "../../state/motion-planning";
import { UnitSwitch } from "../../widgets/unit-switch";
import { JointRow } from "../joints/joint-row";
import type { Tab } from "./tab";

/** The tab "Joints": a slider for each joint of the goal state, within its limits. */
export class JointsTab implements Tab {
  readonly element: HTMLElement;
  private readonly list = h("div", { class: "joints" });
  private rows: JointRow[] = [];
  private shownJoints = "";

  constructor(
    private readonly planning: MotionPlanning,
    private readonly angles: AngleUnits,
  ) {
    this.element = h("div", { class: "planning-joints" }, h("div", { class: "planning-units" }, new UnitSwitch(angles).element), this.list);
    angles.changed.on(() => this.rows.forEach((row) => row.showUnit()));
  }

  show({ joints }: MotionPlanningState): void {
    const key = JSON.stringify(joints.map(({ name, kind, lower, upper }) => [name, kind, lower, upper]));
    if (key !== this.shownJoints) {
      this.shownJoints = key;
      this.rows = joints.map(({ name, kind, lower, upper }) => {
        const zero = Math.min(Math.max(0, lower), upper);
        const control = { name, kind, lower, upper, zero, mimic: null, multiplier: 1, offset: 0 };
        return new JointRow(control, this.angles, (position) => this.planning.send({ type: "set_query_joint", query: "goal", joint: name, position }));
      });
      this.list.replaceChildren(...this.rows.map((row) => row.element));
    }
    joints.forEach(({ position }, i) => this.rows[i]?.setPosition(position));
  }
}
