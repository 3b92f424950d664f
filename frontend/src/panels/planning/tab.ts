import type { MotionPlanningState } from "../../protocol";

/** A tab of the MotionPlanning panel. */
export interface Tab {
  readonly element: HTMLElement;
  show(state: MotionPlanningState): void;
}
