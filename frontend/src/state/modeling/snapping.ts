import { Signal } from "../../signal";
import type { TextStorage } from "../../storage";

const STORAGE_KEY = "linkwright.snapping";
const RADIANS_PER_DEGREE = Math.PI / 180;

/** The steps to choose from, m and degrees. */
export const LENGTH_STEPS_M = [0.01, 0.05, 0.1, 0.25, 0.5, 1] as const;
export const ANGLE_STEPS_DEG = [1, 5, 15, 30, 45, 90] as const;

/** Rounds to the nearest multiple of a step, without floating-point noise. */
export function snap(value: number, step: number): number {
  return step > 0 ? Number((Math.round(value / step) * step).toPrecision(12)) : value;
}

/** The grid for moving, rotating and scaling, stored by the browser. */
export class Snapping {
  readonly changed = new Signal();
  private isOn: boolean;
  private length: number;
  private angle = 15;

  /** `key` is the storage key; `defaults` apply until the user changes the settings, with a length in m. */
  constructor(
    private readonly storage: TextStorage,
    private readonly key = STORAGE_KEY,
    defaults = { on: true, length: 0.1 },
  ) {
    [this.isOn, this.length] = [defaults.on, defaults.length];
    const [state, length, angle] = (storage.getItem(key) ?? "").split(" ");
    if (!(Number(length) > 0 && Number(angle) > 0)) return;
    [this.isOn, this.length, this.angle] = [state === "on", Number(length), Number(angle)];
  }

  get isEnabled(): boolean {
    return this.isOn;
  }

  set isEnabled(isOn: boolean) {
    this.isOn = isOn;
    this.store();
  }

  /** The step of the grid, m. */
  get meters(): number {
    return this.length;
  }

  set meters(length: number) {
    this.length = length;
    this.store();
  }

  get degrees(): number {
    return this.angle;
  }

  set degrees(angle: number) {
    this.angle = angle;
    this.store();
  }

  /** Returns the current steps, m and rad, 0 without a grid; `isInverted` while Ctrl is held. */
  chooseSteps(isInverted: boolean): { length: number; angle: number } {
    const isOn = this.isOn !== isInverted;
    return { length: isOn ? this.length : 0, angle: isOn ? this.angle * RADIANS_PER_DEGREE : 0 };
  }

  private store(): void {
    this.storage.setItem(this.key, `${this.isOn ? "on" : "off"} ${this.length} ${this.angle}`);
    this.changed.emit();
  }
}
