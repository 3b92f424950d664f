import type { JointControl } from "../protocol.gen";
import { Signal } from "./signal";

/** The Joints panel's rows and the positions the server last told. */
export class JointsState {
  readonly controlsChanged = new Signal();
  readonly positionsChanged = new Signal();
  /** Null while nothing publishes from sliders. */
  controls: readonly JointControl[] | null = null;
  positions: Readonly<Record<string, number>> = {};

  setControls(controls: readonly JointControl[] | null): void {
    this.controls = controls;
    this.controlsChanged.emit();
  }

  setPositions(positions: Readonly<Record<string, number>>): void {
    this.positions = positions;
    this.positionsChanged.emit();
  }
}
