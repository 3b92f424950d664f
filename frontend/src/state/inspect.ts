import { Signal } from "../signal";
import type { TextStorage } from "../storage";

const KEY = "linkwright.inspect";

/** The invisible properties of a robot that are drawn. */
export interface Inspected {
  /** Centers of mass of the links and of the whole robot. */
  centers: boolean;
  /** Boxes with the same inertia. */
  boxes: boolean;
  /** Ellipsoids with the same inertia. */
  ellipsoids: boolean;
  /** Axes of joints, their limits and positions. */
  joints: boolean;
  /** Collisions over pale visuals. */
  contrast: boolean;
  /** Frames of links, in a size and color by their depth in the tree. */
  frames: boolean;
}

const NOTHING: Inspected = {
  centers: false,
  boxes: false,
  ellipsoids: false,
  joints: false,
  contrast: false,
  frames: false,
};

/**
 * The user's choice of invisible properties to draw. The browser stores it, because .rviz files have no place for it.
 */
export class InspectState {
  readonly changed = new Signal();
  private settings: Inspected;
  private size: number;
  private depth: number | null = null;

  constructor(private readonly storage: TextStorage) {
    const { scale, ...shown } = parseSettings(storage.getItem(KEY));
    this.settings = { ...NOTHING, ...shown };
    this.size = scale;
  }

  get current(): Readonly<Inspected> {
    return this.settings;
  }

  /** Whether any choice is on. */
  get isActive(): boolean {
    return Object.values(this.settings).some(Boolean);
  }

  /** The scale of marks, relative to a size that suits the robot. */
  get scale(): number {
    return this.size;
  }

  set scale(scale: number) {
    this.size = scale;
    this.remember();
  }

  /** The depth down to which frames are drawn; null for all. */
  get maxDepth(): number | null {
    return this.depth;
  }

  set maxDepth(depth: number | null) {
    this.depth = depth;
    this.remember();
  }

  set(setting: keyof Inspected, isOn: boolean): void {
    this.settings = { ...this.settings, [setting]: isOn };
    this.remember();
  }

  private remember(): void {
    this.storage.setItem(KEY, JSON.stringify({ ...this.settings, scale: this.size }));
    this.changed.emit();
  }
}

function parseSettings(text: string | null): Partial<Inspected> & { scale: number } {
  try {
    const values = JSON.parse(text ?? "{}") as Record<string, unknown>;
    const settings = Object.keys(NOTHING).map((name) => [name, values[name] === true]);
    const scale = values["scale"];
    return { ...(Object.fromEntries(settings) as Partial<Inspected>), scale: typeof scale === "number" && scale > 0 ? scale : 1 };
  } catch {
    return { scale: 1 };
  }
}
