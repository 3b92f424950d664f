import type { Connection } from "../connection/connection";
import type { Property, PropertyValue, SavedView, View, ViewClass } from "../protocol";
import { Signal } from "../signal";
import type { FrameStore } from "./frames";
import type { Kept } from "./kept";
import { cameraInFixed, cameraInTarget, FIXED, toTarget, type Camera, type Target, type ViewSize } from "./views/camera";
import { controllerOf } from "./views/catalog";
import { holds, spanInTarget } from "./views/fit";
import { distanceBetween, type Span, type Vector } from "./views/vector";
import type { Drag, ViewController, ViewValues } from "./views/view-controller";

export const FIXED_FRAME = "<Fixed Frame>";
const ORBIT = "rviz_default_plugins/Orbit";
const TOP_DOWN = "rviz_default_plugins/TopDownOrtho";
const CURRENT_NAME = "Current View";
const TARGET_FRAME = "Target Frame";
const ANNOUNCE_INTERVAL_MS = 250;

/** The current view and the saved ones. The server proposes one at the start; from then on the page owns its camera. */
export class ViewState {
  readonly changed = new Signal();
  /** The saved views, or the classes, are others now. */
  readonly listsChanged = new Signal();
  classes: readonly ViewClass[] = [];
  saved: readonly SavedView[] = [];
  private view: View = { cls: ORBIT, name: CURRENT_NAME, values: controllerOf(ORBIT).zero() };
  private configured: View | null = null;
  private showsWholeRobot = false;
  /** The content when the camera was last placed to show all of it; null: the user has placed it. */
  private lookedAt: { readonly what: string; readonly box: Span | null } | null = null;
  /** The map that the camera shows all of, if a file placed it and the user has not moved it; "" for none, null: the user has. */
  private framedMap: string | null = null;
  private revision: number | null = null;
  private measuredFor: number | null = null;
  /** A program that was started again does not know the size of the robots yet, wherever the camera is. */
  private measuresAgain = false;
  private lastTarget: Target = FIXED;
  private timer: ReturnType<typeof setTimeout> | undefined;

  constructor(
    private readonly frames: FrameStore,
    private readonly connection: Connection,
  ) {
    connection.on("view_classes", ({ classes }) => {
      this.classes = classes;
      this.listsChanged.emit();
    });
    connection.on("saved_views", ({ views }) => {
      this.saved = views;
      this.listsChanged.emit();
    });
    connection.on("view_state", ({ view, revision, whole_robot }) => this.configure(view, revision, whole_robot));
  }

  get current(): Readonly<View> {
    return this.view;
  }

  get values(): ViewValues {
    return this.view.values;
  }

  /** The rows of the current view's class. */
  get properties(): readonly Property[] {
    return this.propertiesOf(this.view.cls);
  }

  get controller(): ViewController {
    return controllerOf(this.view.cls);
  }

  /** The frame the camera moves with. One that has no transform any more stays where it was, as in RViz. */
  get target(): Target {
    const name = this.view.values[TARGET_FRAME];
    if (typeof name !== "string" || name === FIXED_FRAME) return FIXED;
    const row = this.frames.row(name);
    if (this.frames.has(row)) {
      const [x = 0, y = 0, z = 0, qx = 0, qy = 0, qz = 0, qw = 1] = this.frames.poses.subarray(row * 7, row * 7 + 7);
      const yaw = Math.atan2(2 * (qx * qy + qw * qz), qw * qw + qx * qx - qy * qy - qz * qz);
      this.lastTarget = { position: [x, y, z], yaw: this.controller.followsYaw ? yaw : 0 };
    }
    return this.lastTarget;
  }

  /** The camera in the fixed frame. */
  get camera(): Camera {
    return cameraInFixed(this.controller.camera(this.view.values), this.target);
  }

  propertiesOf(cls: string): readonly Property[] {
    return this.classes.find((each) => each.cls === cls)?.properties ?? [];
  }

  /** No one has placed the camera, and the content differs from the one that it was last placed for. */
  awaitsFit(what: string): boolean {
    return this.lookedAt !== null && what !== this.lookedAt.what;
  }

  /** Has the camera outlive the page. */
  keep(kept: Kept): void {
    const read = () => ({ view: this.view, revision: this.revision, lookedAt: this.lookedAt });
    kept.part("view", read, (before: ReturnType<typeof read>) => Object.assign(this, before));
  }

  /** The program was restarted; for other content, the camera starts from its default again. */
  programRestarted(isSame: boolean): void {
    this.measuresAgain = true;
    if (!isSame) this.revision = null;
  }

  /** The server needs the size of the robots, though the camera stays. */
  get awaitsSize(): boolean {
    return this.measuresAgain;
  }

  /** Looks at all of the robots as soon as they are loaded. */
  lookAtRobots(): void {
    this.awaitFirstLook(true);
  }

  /** Keeps the camera where it is, since the user works with it. */
  stay(): void {
    this.lookedAt = null;
    this.framedMap = null;
  }

  /** Looks at all of a box in the fixed frame, from the side it is seen from, in a canvas of this size. */
  fit(box: Span, size: ViewSize): void {
    this.update(this.fitted(box, size));
  }

  /** As `fit`, for a camera that the user has not placed; repeated when the box has grown, until the user does. */
  fitFirst(box: Span, size: ViewSize, what: string): void {
    const before = this.lookedAt?.box;
    if (!before || !holds(before, box)) this.update(this.fitted(box, size));
    this.lookedAt = { what, box: before && holds(before, box) ? before : box };
  }

  /** A file placed the camera, it shows a map from above, and the user has not moved it; it does not show all of this map yet. */
  awaitsMap(map: string): boolean {
    return this.view.cls === TOP_DOWN && this.framedMap !== null && this.framedMap !== map;
  }

  /** Shows all of a map. The file keeps its own view. */
  frameMap(box: Span, size: ViewSize, map: string): void {
    this.framedMap = map;
    this.view = { ...this.view, values: { ...this.values, ...this.bounded(TOP_DOWN, this.fitted(box, size)) } };
    this.changed.emit();
  }

  /**
   * Reports the size of the robots, as long as the user has not moved the camera or to a program that was restarted, and
   * the height of the ground below them, once all of them are loaded.
   */
  measured({ min, max }: Span, ground: number): void {
    if (!this.measuresAgain && (this.lookedAt === null || this.measuredFor === this.revision)) return;
    this.measuresAgain = false;
    this.measuredFor = this.revision;
    this.connection.send({ type: "robot_measured", diagonal: distanceBetween(min, max), ground });
  }

  /** Sets the values of a camera that the user has not placed; it waits for more content, unless `isLast`. */
  propose(values: ViewValues, what: string, isLast: boolean): void {
    this.update(values);
    if (!isLast) this.lookedAt = { what, box: null };
  }

  /** Takes values, each within the bounds of its property. */
  update(values: ViewValues): void {
    this.change({ ...this.view, values: { ...this.view.values, ...this.bounded(this.view.cls, values) } });
  }

  drag(drag: Drag): void {
    this.update(this.controller.drag(this.view.values, drag));
  }

  /** `delta` is 120 a notch, positive away from the user. */
  wheel(delta: number, shift: boolean): void {
    this.update(this.controller.wheel(this.view.values, delta, shift));
  }

  /** Sets the focal point, in the fixed frame. */
  lookAt(point: Vector): void {
    this.update(this.controller.lookAt(this.view.values, toTarget(point, this.target)));
  }

  /** Another class of view, that looks as the one before does. */
  setClass(cls: string): void {
    if (cls === this.view.cls) return;
    const before = this.view;
    const inFixed = this.camera;
    const defaults = this.defaultsOf(cls);
    const kept = before.values[TARGET_FRAME];
    this.view = { ...before, cls, values: kept === undefined ? defaults : { ...defaults, [TARGET_FRAME]: kept } };
    const camera = cameraInTarget(inFixed, this.target);
    this.update(this.controller.mimic({ cls: before.cls, values: before.values, camera }));
  }

  /** Follows another frame without moving the camera. */
  setTargetFrame(name: string): void {
    const before = this.target;
    this.view = { ...this.view, values: { ...this.view.values, [TARGET_FRAME]: name } };
    this.update(this.controller.retarget(this.view.values, before, this.target));
  }

  /** Sets one property as its row in the Views panel does. */
  set(path: string, value: PropertyValue): void {
    if (path === TARGET_FRAME) this.setTargetFrame(String(value));
    else this.update({ [path]: value });
  }

  /** RViz's Zero button. */
  zero(): void {
    this.update(this.controller.zero());
  }

  /** Back to the view of the configuration file, or to all of the robot where it has none. */
  reset(): void {
    if (!this.configured) this.zero();
    else {
      this.awaitFirstLook(this.showsWholeRobot);
      this.show(copyOf(this.configured));
    }
  }

  // --- saved views -----------------------------------------------------------------------------------------------

  /** Adds the current view to the saved ones. */
  save(name: string): void {
    this.connection.send({ type: "save_view", view: { ...copyOf(this.view), name } });
  }

  /** Looks as a saved view does. */
  use(id: string): void {
    const saved = this.saved.find((each) => each.id === id);
    if (saved) this.change({ ...copyOf(saved.view), name: CURRENT_NAME });
  }

  rename(id: string, name: string): void {
    const saved = this.saved.find((each) => each.id === id);
    if (saved && name.trim() !== "") this.changeSaved(id, { ...copyOf(saved.view), name: name.trim() });
  }

  setSaved(id: string, path: string, value: PropertyValue): void {
    const saved = this.saved.find((each) => each.id === id);
    if (!saved) return;
    const { cls, values } = saved.view;
    this.changeSaved(id, { ...saved.view, values: { ...values, ...this.bounded(cls, { [path]: value }) } });
  }

  remove(id: string): void {
    this.connection.send({ type: "remove_saved_view", id });
  }

  // --------------------------------------------------------------------------------------------------------------

  /** Applies the view of a configuration, once; a reconnect does not move the user's camera, another file does. */
  private configure(view: View, revision: number, showsWholeRobot: boolean): void {
    const known = this.revision === revision;
    this.configured = view;
    this.revision = revision;
    this.showsWholeRobot = showsWholeRobot;
    if (known) return;
    this.awaitFirstLook(showsWholeRobot);
    this.view = copyOf(view);
    this.changed.emit();
  }

  private awaitFirstLook(awaits: boolean): void {
    this.lookedAt = awaits ? { what: "", box: null } : null;
    this.framedMap = "";
  }

  private fitted(box: Span, size: ViewSize): ViewValues {
    return this.controller.fit(this.view.values, spanInTarget(box, this.target), size);
  }

  private change(view: View): void {
    this.lookedAt = null;
    this.framedMap = null;
    this.show(view);
  }

  private show(view: View): void {
    this.view = view;
    this.changed.emit();
    this.timer ??= setTimeout(() => {
      this.timer = undefined;
      this.connection.send({ type: "view_changed", view: copyOf(this.view) });
    }, ANNOUNCE_INTERVAL_MS);
  }

  private changeSaved(id: string, view: View): void {
    this.connection.send({ type: "change_saved_view", id, view });
  }

  private defaultsOf(cls: string): ViewValues {
    return this.classes.find((each) => each.cls === cls)?.defaults ?? controllerOf(cls).zero();
  }

  private bounded(cls: string, values: ViewValues): ViewValues {
    const result: Record<string, PropertyValue> = {};
    for (const [path, value] of Object.entries(values)) {
      const property = find(this.propertiesOf(cls), path);
      if (typeof value !== "number") result[path] = value;
      else if (Number.isFinite(value)) {
        result[path] = Math.min(Math.max(value, property?.minimum ?? -Infinity), property?.maximum ?? Infinity);
      }
    }
    return result;
  }
}

function copyOf(view: View): View {
  return { ...view, values: { ...view.values } };
}

function find(properties: readonly Property[], id: string): Property | undefined {
  for (const property of properties) {
    if (property.id === id) return property;
    const below = find(property.children, id);
    if (below) return below;
  }
  return undefined;
}
