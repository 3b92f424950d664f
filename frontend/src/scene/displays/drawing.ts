import type { Camera, Object3D, Raycaster, Scene, Vector3, WebGLRenderer } from "three";
import type { DisplayData } from "../../connection/data";
import type { DisplayState } from "../../state/displays";
import type { Session } from "../../state/session";
import type { MeshLibrary } from "../meshes/mesh-library";
import type { MovingView } from "../robot/moving-meshes";
import type { PanelHost } from "./display-panel";
import type { DescriptionRow, Hit, Interaction, ScenePointer, SelectionBox } from "../picking";

/** The objects that a drawing uses. */
export interface DrawingContext {
  readonly display: DisplayState;
  readonly session: Session;
  readonly meshes: MeshLibrary;
  /** The host for the display's own panels. */
  readonly panels: PanelHost;
  /** The element over the canvas for what drawings show in front of the scene. */
  readonly overScene: HTMLElement;
  /** Requests a frame. */
  readonly invalidate: () => void;
  /** Shows something outside the scene in step with the next frame, see `FrameLoop.schedule`. */
  readonly showWithFrame: (show: () => void) => void;
  /** Returns the current camera of the 3-D view. */
  readonly getCamera: () => Camera;
  /** Whether a light with shadows would not make the page slow. */
  readonly canAffordStudio: () => boolean;
}

/** The scene just drawn, for displays that draw it a second time. */
export interface DrawnScene {
  readonly renderer: WebGLRenderer;
  readonly scene: Scene;
  /** The background color of the scene. */
  readonly background: string;
  /** Runs `draw` while only the accepted displays are visible. */
  drawOnly(accepts: (display: DisplayState) => boolean, draw: () => void): void;
}

/** The drawing of a display. The stage shows `root` while the display is enabled. */
export interface Drawing {
  readonly root: Object3D;
  /** Whether the display draws nothing into the scene, so that its content requires no frame. */
  readonly isElsewhere?: boolean;
  /**
   * Called when a value or the rows of the display changed; the drawing reads what it needs from `display.rows` again.
   */
  onPropertiesChanged(): void;
  /** Called before every frame while the display is enabled, to update the poses of its objects. */
  update(): void;
  /**
   * Called before a coarse frame of a moving scene, to omit invisible details; with null after the motion, to draw
   * everything again.
   */
  simplify?(view: MovingView | null): void;
  /** Called with new content; a drawing created later receives earlier content, too. */
  onDataChanged?(data: DisplayData): void;
  /** Called when the content under a key, or all content (null), must no longer be drawn. */
  onDataRemoved?(key: string | null): void;
  /** Called after every frame while the display is enabled, for displays that show the scene elsewhere. */
  afterFrame?(scene: DrawnScene): void;
  /** Returns false while requested data is still loading. */
  isSettled?(): boolean;
  /** Returns the nearest object that a ray hits. */
  pick?(ray: Raycaster): Hit | null;
  /** Returns the keys of the objects within a rectangle on the screen. */
  pickBox?(box: SelectionBox): readonly string[];
  /** Returns what the Selection panel shows of an object now; null if the object no longer exists. */
  describe?(key: string): DescriptionRow | null;
  /** Returns the three.js objects that draw an object, for outlining and focusing. */
  objectsOf?(key: string): readonly Object3D[];
  /** Returns the position of an object in the fixed frame, for objects without three.js objects of their own. */
  positionOf?(key: string): Vector3 | null;
  /** Called with the keys of the selected objects, for drawings that mark the selection themselves. */
  highlight?(keys: ReadonlySet<string>): void;
  /** Handles the Interact tool's events over an object that `pick` returned; returns true to keep the camera still. */
  onPointer?(event: ScenePointer): boolean;
  /** Called when the Interact tool is activated or deactivated, or an object is held with it. */
  onInteractionChanged?(interaction: Interaction): void;
  /** Returns what is drawn, for tests: counts, bounds, colors. */
  inspect?(): object;
  dispose(): void;
}

/** The constructor of a drawing; `registry.ts` lists one for each RViz display class. */
export type DrawingClass = new (context: DrawingContext) => Drawing;

