import type { Object3D, Raycaster } from "three";
import type { DisplayState } from "../../state/displays";
import type { Session } from "../../state/session";
import type { MeshLibrary } from "../meshes/mesh-library";

/** What a drawing is given to work with. */
export interface DrawingContext {
  readonly display: DisplayState;
  readonly session: Session;
  readonly meshes: MeshLibrary;
  /** Asks for a frame. */
  readonly invalidate: () => void;
}

/** A link hit by a ray. */
export interface Hit {
  link: string;
  distance: number;
}

/** What one display draws. The stage shows and hides `root` with the display's enable box. */
export interface Drawing {
  readonly root: Object3D;
  /** A value or the rows of the display changed; read anew what matters from `display.rows`. */
  propertiesChanged(): void;
  /** Called before every frame drawn while the display is enabled: put everything where it is now. */
  update(): void;
  /** False while something that was asked for is still being loaded. */
  settled?(): boolean;
  /** Nearest link under the ray. */
  pick?(ray: Raycaster): Hit | null;
  /** The objects that draw a link, for highlighting. */
  objectsOf?(link: string): readonly Object3D[];
  dispose(): void;
}

/** How a display comes to be drawn: one class for each RViz display class, listed in `registry.ts`. */
export type DrawingClass = new (context: DrawingContext) => Drawing;

