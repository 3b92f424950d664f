import { Signal } from "../signal";
import type { TextStorage } from "../storage";

const STORAGE_KEY = "linkwright.inspect";

/** The invisible properties of a robot that are drawn. */
export interface InspectedProperties {
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

const ALL_OFF: InspectedProperties = {
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
  private settings: InspectedProperties;
  private markScale: number;
  private depth: number | null = null;

  constructor(private readonly storage: TextStorage) {
    const { scale, ...switches } = parseSettings(storage.getItem(STORAGE_KEY));
    this.settings = { ...ALL_OFF, ...switches };
    this.markScale = scale;
  }

  get current(): Readonly<InspectedProperties> {
    return this.settings;
  }

  /** Whether any choice is on. */
  get isActive(): boolean {
    return Object.values(this.settings).some(Boolean);
  }

  /** The scale of marks, relative to a size that suits the robot. */
  get scale(): number {
    return this.markScale;
  }

  set scale(scale: number) {
    this.markScale = scale;
    this.store();
  }

  /** The depth down to which frames are drawn; null for all. */
  get maxDepth(): number | null {
    return this.depth;
  }

  set maxDepth(depth: number | null) {
    this.depth = depth;
    this.store();
  }

  set(setting: keyof InspectedProperties, isOn: boolean): void {
    this.settings = { ...this.settings, [setting]: isOn };
    this.store();
  }

  private store(): void {
    this.storage.setItem(STORAGE_KEY, JSON.stringify({ ...this.settings, scale: this.markScale }));
    this.changed.emit();
  }
}

function parseSettings(text: string | null): Partial<InspectedProperties> & { scale: number } {
  try {
    const values = JSON.parse(text ?? "{}") as Record<string, unknown>;
    const settings = Object.keys(ALL_OFF).map((name) => [name, values[name] === true]);
    const scale = values["scale"];
    return { ...(Object.fromEntries(settings) as Partial<InspectedProperties>), scale: typeof scale === "number" && scale > 0 ? scale : 1 };
  } catch {
    return { scale: 1 };
  }
}
