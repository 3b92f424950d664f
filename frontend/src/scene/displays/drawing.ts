import type { Camera, Object3D, Raycaster, Scene, Vector3, WebGLRenderer } from "three";
import type { DisplayData } from "../../connection/data";
import type { DisplayState } from "../../state/displays";
import type { Session } from "../../state/session";
import type { MeshLibrary } from "../meshes/mesh-library";
import type { MovingView } from "../robot/moving-meshes";
import type { PanelHost } from "./display-panel";
import type { Described, Hit, Interaction, ScenePointer, SelectionBox } from "../picking";

/** The objects that a drawing works with. */
export interface DrawingContext {
  readonly display: DisplayState;
  readonly session: Session;
  readonly meshes: MeshLibrary;
  /** Takes panels of the display's own. */
  readonly panels: PanelHost;
  /** Asks for a frame. */
  readonly invalidate: () => void;
  /** Has something shown beside the scene together with the next frame, see `FrameLoop.beside`. */
  readonly beside: (show: () => void) => void;
  /** The camera of the 3-D view, as it is now. */
  readonly camera: () => Camera;
  /** Whether a light with shadows does not make the page slow. */
  readonly affordsStudio: () => boolean;
}

/** The scene as it was just drawn, for displays that draw it once more. */
export interface DrawnScene {
  readonly renderer: WebGLRenderer;
  readonly scene: Scene;
  /** The colour behind the scene. */
  readonly background: string;
  /** Runs `draw` with only those displays to be seen that are accepted. */
  showing(accepts: (display: DisplayState) => boolean, draw: () => void): void;
}

/** The drawing of a display. The stage shows and hides `root` with the display's enable box. */
export interface Drawing {
  readonly root: Object3D;
  /** It has no place in the scene, so that its content asks for no frame. */
  readonly isElsewhere?: boolean;
  /** A value or the rows of the display changed; read the relevant values from `display.rows` again. */
  propertiesChanged(): void;
  /** Called before every frame drawn while the display is enabled: put everything where it is now. */
  update(): void;
  /** Called before a frame of a moving scene that is drawn coarsely: draw less where no user sees it; null after it: all again. */
  move?(view: MovingView | null): void;
  /** New content; a drawing made later receives the earlier content, too. */
  dataChanged?(data: DisplayData): void;
  /** The content under a key, or all of it (null), is to be drawn no more. */
  dataForgotten?(key: string | null): void;
  /** Called after every frame while the display is enabled: draw what shows the scene elsewhere. */
  drawn?(scene: DrawnScene): void;
  /** False while something that was asked for is still being loaded. */
  settled?(): boolean;
  /** The nearest thing under the ray. */
  pick?(ray: Raycaster): Hit | null;
  /** The keys of the things within a box on the screen. */
  pickBox?(box: SelectionBox): readonly string[];
  /** What the Selection panel shows of a thing as it is now; null when it is there no more. */
  describe?(key: string): Described | null;
  /** The objects that draw a thing, for outlining and focusing. */
  objectsOf?(key: string): readonly Object3D[];
  /** Where a thing is, in the fixed frame, for those that no object draws. */
  placeOf?(key: string): Vector3 | null;
  /** The things selected now, for things that are not objects of their own and show it themselves. */
  highlight?(keys: ReadonlySet<string>): void;
  /** The Interact tool's events while the pointer is over what `pick` gives; true takes it: the camera stays still. */
  pointer?(event: ScenePointer): boolean;
  /** The Interact tool is taken in hand or put away, or something is being held with it. */
  interactionChanged?(interaction: Interaction): void;
  /** What is drawn, for tests: counts, bounds, colours. */
  inspect?(): object;
  dispose(): void;
}

/** The constructor of a drawing: one class for each RViz display class, listed in `registry.ts`. */
export type DrawingClass = new (context: DrawingContext) => Drawing;

