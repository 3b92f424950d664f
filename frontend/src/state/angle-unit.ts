import { Signal } from "../signal";
import type { TextStorage } from "../storage";

export type AngleUnit = "rad" | "deg";

const STORAGE_KEY = "linkwright.angle-unit";
const DEGREES_PER_RADIAN = 180 / Math.PI;

/** The unit in which angles are shown and typed, stored by the browser. */
export class AngleUnits {
  readonly changed = new Signal();
  private unit: AngleUnit;

  constructor(private readonly storage: TextStorage) {
    this.unit = storage.getItem(STORAGE_KEY) === "deg" ? "deg" : "rad";
  }

  get current(): AngleUnit {
    return this.unit;
  }

  set current(unit: AngleUnit) {
    this.unit = unit;
    this.storage.setItem(STORAGE_KEY, unit);
    this.changed.emit();
  }

  /** Returns the factor from a joint's position to the displayed value: 1 for meters. */
  scaleOf(kind: string): number {
    return kind !== "prismatic" && this.unit === "deg" ? DEGREES_PER_RADIAN : 1;
  }
}
