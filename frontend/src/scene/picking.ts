import type { Object3D, Raycaster, Vector3 } from "three";

/** A thing of a display that a ray met. */
export interface Hit {
  /** Names the thing within its display while it exists: a link, a marker's namespace and id, a point's number. */
  key: string;
  /** From the ray's origin, m. */
  distance: number;
  /** Where, in the fixed frame, m. */
  point: Vector3;
  /** It is in the way of the ray, but nothing to select: a map, points that are not selectable. */
  isGround?: true;
}

/** A rectangle on the screen, and the things visible in it, without things behind others. */
export interface SelectionBox {
  /** Whether a point of the fixed frame is seen in the rectangle. */
  hasPoint(x: number, y: number, z: number): boolean;
  /** Whether a part of an object, whose world matrix is current, is seen in it. */
  hasObject(object: Object3D): boolean;
}

/** A row of the Selection panel. */
export interface Described {
  name: string;
  value?: string;
  children?: readonly Described[];
}

/** An event of the mouse over the scene, as the Interact tool hands it to drawings. */
export interface ScenePointer {
  /** `enter` and `leave`: the pointer comes over a thing of the drawing or goes away from it. */
  readonly type: "enter" | "leave" | "move" | "down" | "up" | "wheel";
  /** Pixels from the canvas' upper left corner. */
  readonly x: number;
  readonly y: number;
  readonly dx: number;
  readonly dy: number;
  /** The button that went down or up. */
  readonly button: "left" | "middle" | "right" | null;
  readonly shift: boolean;
  readonly ctrl: boolean;
  /** From the camera through the pointer. */
  readonly ray: Raycaster;
  /** What of the drawing the ray meets; while something is held, what it met when it was taken. */
  readonly hit: Hit | null;
  setCursor(cursor: string): void;
  /** Sets the text of the status line. */
  setHint(hint: string): void;
}

/** Whether things can be moved with the Interact tool now. */
export interface Interaction {
  /** The Interact tool is in hand. */
  enabled: boolean;
  /** Something is held, and the tool hides what is not. */
  hideOthers: boolean;
}
