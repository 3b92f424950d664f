import type { Object3D, Raycaster, Vector3 } from "three";

/** An object of a display that a ray hit. */
export interface Hit {
  /**
   * Identifies the object within its display while it exists: the name of a link, namespace and ID of a marker, index
   * of a point.
   */
  key: string;
  /** The distance from the ray's origin, m. */
  distance: number;
  /** The point of the hit, in the fixed frame, m. */
  point: Vector3;
  /** Set for objects that stop a ray but cannot be selected: a map, or points that are not selectable. */
  isGround?: true;
}

/** A rectangle on the screen, which contains the objects visible in it, without hidden ones. */
export interface SelectionBox {
  /** Whether a point of the fixed frame is visible in the rectangle. */
  hasPoint(x: number, y: number, z: number): boolean;
  /** Whether a part of an object, whose world matrix must be current, is visible in the rectangle. */
  hasObject(object: Object3D): boolean;
}

/** A row of the Selection panel. */
export interface DescriptionRow {
  name: string;
  value?: string;
  children?: readonly DescriptionRow[];
}

/** A mouse event over the scene, as the Interact tool passes it to drawings. */
export interface ScenePointer {
  /** `enter` and `leave`: the pointer moved onto an object of the drawing, or away from it. */
  readonly type: "enter" | "leave" | "move" | "down" | "up" | "wheel";
  /** The position on the canvas, pixels from its upper left corner. */
  readonly x: number;
  readonly y: number;
  readonly dx: number;
  readonly dy: number;
  /** The button that was pressed or released. */
  readonly button: "left" | "middle" | "right" | null;
  readonly isShiftDown: boolean;
  readonly isCtrlDown: boolean;
  /** The ray from the camera through the pointer. */
  readonly ray: Raycaster;
  /** The object of the drawing that the ray hits; during a drag, the one that was grabbed. */
  readonly hit: Hit | null;
  setCursor(cursor: string): void;
  /** Sets the text of the status line. */
  setHint(hint: string): void;
}

/** The state of the Interact tool. */
export interface Interaction {
  /** Whether the Interact tool is active. */
  isEnabled: boolean;
  /** Whether an object is being dragged, and the tool hides all others. */
  hidesOthers: boolean;
}
