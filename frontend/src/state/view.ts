import type { Connection } from "../connection/connection";
import type { Property, PropertyValue, SavedView, View, ViewClass } from "../protocol";
import { Signal } from "../signal";
import type { FrameStore } from "./frames";
import type { PageMemory } from "./page-memory";
import { transformToFixed, transformToTarget, FIXED_TARGET, transformPointToTarget, type Camera, type Target, type ViewSize } from "./views/camera";
import { controllerOf } from "./views/catalog";
import { containsBounds, transformBounds } from "./views/fit";
import { distanceBetween, type Bounds, type Vector } from "./views/vector";
import type { Drag, ViewController, ViewValues } from "./views/view-controller";

export const FIXED_FRAME = "<Fixed Frame>";
const ORBIT_CLASS = "rviz_default_plugins/Orbit";
const TOP_DOWN_CLASS = "rviz_default_plugins/TopDownOrtho";
const CURRENT_VIEW_NAME = "Current View";
const TARGET_FRAME_PATH = "Target Frame";
const ANNOUNCE_INTERVAL_MS = 250;

/**
 * The current view and the saved ones. The server proposes a view at the start; from then on the page controls its
 * camera.
 */
export class ViewState {
  readonly changed = new Signal();
  /** The saved views or the classes changed. */
  readonly listsChanged = new Signal();
  classes: readonly ViewClass[] = [];
  savedViews: readonly SavedView[] = [];
  private view: View = { cls: ORBIT_CLASS, name: CURRENT_VIEW_NAME, values: controllerOf(ORBIT_CLASS).zero() };
  private configuredView: View | null = null;
  private showsWholeRobot = false;
  /** The content for which the camera was last placed automatically; null once the user has placed it. */
  private fittedContent: { readonly target: string; readonly box: Bounds | null } | null = null;
  /**
   * The map that the camera was fitted to, if a file placed the camera and the user has not moved it; "" for none yet,
   * null once the user has moved it.
   */
  private fittedMap: string | null = null;
  private revision: number | null = null;
  private reportedRevision: number | null = null;
  /** Whether a restarted program needs the size of the robots, even if the camera stays. */
  private needsSize = false;
  private lastTarget: Target = FIXED_TARGET;
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
      this.savedViews = views;
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

  /** The properties of the current view's class. */
  get properties(): readonly Property[] {
    return this.propertiesOf(this.view.cls);
  }

  get controller(): ViewController {
    return controllerOf(this.view.cls);
  }

  /**
   * The pose of the frame with which the camera moves. If the frame has lost its transform, its last pose is used, as
   * in RViz.
   */
  get target(): Target {
    const name = this.view.values[TARGET_FRAME_PATH];
    if (typeof name !== "string" || name === FIXED_FRAME) return FIXED_TARGET;
    const row = this.frames.rowOf(name);
    if (this.frames.hasPose(row)) {
      const [x = 0, y = 0, z = 0, qx = 0, qy = 0, qz = 0, qw = 1] = this.frames.poses.subarray(row * 7, row * 7 + 7);
      const yaw = Math.atan2(2 * (qx * qy + qw * qz), qw * qw + qx * qx - qy * qy - qz * qz);
      this.lastTarget = { position: [x, y, z], yaw: this.controller.followsYaw ? yaw : 0 };
    }
    return this.lastTarget;
  }

  /** The camera in the fixed frame. */
  get camera(): Camera {
    return transformToFixed(this.controller.computeCamera(this.view.values), this.target);
  }

  propertiesOf(cls: string): readonly Property[] {
    return this.classes.find((viewClass) => viewClass.cls === cls)?.properties ?? [];
  }

  /**
   * Returns whether the user has not placed the camera, and the content differs from that for which it was last placed.
   */
  awaitsFit(contentId: string): boolean {
    return this.fittedContent !== null && contentId !== this.fittedContent.target;
  }

  /** Preserves the camera across reloads of the page. */
  preserveIn(memory: PageMemory): void {
    const readState = () => ({ view: this.view, revision: this.revision, fittedContent: this.fittedContent });
    memory.preserve("view", readState, (state: ReturnType<typeof readState>) => Object.assign(this, state));
  }

  /** Handles a restart of the program; if it shows other content, the camera starts from its default again. */
  onProgramRestarted(isSameContent: boolean): void {
    this.needsSize = true;
    if (!isSameContent) this.revision = null;
  }

  /** Whether the server needs the size of the robots although the camera stays. */
  get awaitsSize(): boolean {
    return this.needsSize;
  }

  /** Fits the robots into view once they are loaded. */
  lookAtRobots(): void {
    this.setAwaitingFirstFit(true);
  }

  /** Keeps the camera in place from now on, because the user works with the view. */
  keepCamera(): void {
    this.fittedContent = null;
    this.fittedMap = null;
  }

  /** Fits a box in the fixed frame into view from the current direction, in a canvas of this size. */
  fit(box: Bounds, size: ViewSize): void {
    this.update(this.fitValues(box, size));
  }

  /** Fits a box into view if the user has not placed the camera, and again when the box has grown. */
  fitFirst(box: Bounds, size: ViewSize, contentId: string): void {
    const previousBox = this.fittedContent?.box;
    if (!previousBox || !containsBounds(previousBox, box)) this.update(this.fitValues(box, size));
    this.fittedContent = { target: contentId, box: previousBox && containsBounds(previousBox, box) ? previousBox : box };
  }

  /**
   * Returns whether a file placed the camera above a map, the user has not moved it, and it does not show the whole of
   * this map yet.
   */
  awaitsMapFit(map: string): boolean {
    return this.view.cls === TOP_DOWN_CLASS && this.fittedMap !== null && this.fittedMap !== map;
  }

  /** Fits a map into view, without changing the view of the file. */
  fitMap(box: Bounds, size: ViewSize, map: string): void {
    this.fittedMap = map;
    this.view = { ...this.view, values: { ...this.values, ...this.clampToBounds(TOP_DOWN_CLASS, this.fitValues(box, size)) } };
    this.changed.emit();
  }

  /**
   * Reports the size of the robots and the height of the ground below them, once all are loaded, if the user has not
   * moved the camera or the program was restarted.
   */
  reportSize({ min, max }: Bounds, ground: number): void {
    if (!this.needsSize && (this.fittedContent === null || this.reportedRevision === this.revision)) return;
    this.needsSize = false;
    this.reportedRevision = this.revision;
    this.connection.send({ type: "robot_measured", diagonal: distanceBetween(min, max), ground });
  }

  /**
   * Sets the values of a camera that the user has not placed; unless `isLast`, it is placed again for further content.
   */
  proposeValues(values: ViewValues, contentId: string, isLast: boolean): void {
    this.update(values);
    if (!isLast) this.fittedContent = { target: contentId, box: null };
  }

  /** Sets values, limited to the bounds of their properties. */
  update(values: ViewValues): void {
    this.change({ ...this.view, values: { ...this.view.values, ...this.clampToBounds(this.view.cls, values) } });
  }

  drag(drag: Drag): void {
    this.update(this.controller.drag(this.view.values, drag));
  }

  /** Handles the wheel; `delta` is 120 per notch, positive away from the user. */
  handleWheel(delta: number, isShiftDown: boolean): void {
    this.update(this.controller.applyWheel(this.view.values, delta, isShiftDown));
  }

  /** Moves the focal point, given in the fixed frame. */
  lookAt(point: Vector): void {
    this.update(this.controller.lookAt(this.view.values, transformPointToTarget(point, this.target)));
  }

  /** Changes the class of the view, and keeps the camera as far as the class permits. */
  setClass(cls: string): void {
    if (cls === this.view.cls) return;
    const previousView = this.view;
    const cameraInFixedFrame = this.camera;
    const defaults = this.defaultsOf(cls);
    const targetFrame = previousView.values[TARGET_FRAME_PATH];
    this.view = { ...previousView, cls, values: targetFrame === undefined ? defaults : { ...defaults, [TARGET_FRAME_PATH]: targetFrame } };
    const camera = transformToTarget(cameraInFixedFrame, this.target);
    this.update(this.controller.mimic({ cls: previousView.cls, values: previousView.values, camera }));
  }

  /** Follows another frame without moving the camera. */
  setTargetFrame(name: string): void {
    const previousTarget = this.target;
    this.view = { ...this.view, values: { ...this.view.values, [TARGET_FRAME_PATH]: name } };
    this.update(this.controller.retarget(this.view.values, previousTarget, this.target));
  }

  /** Sets a property as its row in the Views panel does. */
  setProperty(path: string, value: PropertyValue): void {
    if (path === TARGET_FRAME_PATH) this.setTargetFrame(String(value));
    else this.update({ [path]: value });
  }

  /** Applies RViz's Zero button. */
  zero(): void {
    this.update(this.controller.zero());
  }

  /** Restores the view of the configuration file, or fits the robots into view if there is none. */
  reset(): void {
    if (!this.configuredView) this.zero();
    else {
      this.setAwaitingFirstFit(this.showsWholeRobot);
      this.setView(copyView(this.configuredView));
    }
  }

  /** Adds the current view to the saved ones. */
  save(name: string): void {
    this.connection.send({ type: "save_view", view: { ...copyView(this.view), name } });
  }

  /** Applies a saved view. */
  applySaved(id: string): void {
    const savedView = this.savedViews.find((candidate) => candidate.id === id);
    if (savedView) this.change({ ...copyView(savedView.view), name: CURRENT_VIEW_NAME });
  }

  rename(id: string, name: string): void {
    const savedView = this.savedViews.find((candidate) => candidate.id === id);
    if (savedView && name.trim() !== "") this.changeSaved(id, { ...copyView(savedView.view), name: name.trim() });
  }

  setSavedValue(id: string, path: string, value: PropertyValue): void {
    const savedView = this.savedViews.find((candidate) => candidate.id === id);
    if (!savedView) return;
    const { cls, values } = savedView.view;
    this.changeSaved(id, { ...savedView.view, values: { ...values, ...this.clampToBounds(cls, { [path]: value }) } });
  }

  remove(id: string): void {
    this.connection.send({ type: "remove_saved_view", id });
  }

  /** Applies the view of a configuration once: a reconnect does not move the user's camera, but another file does. */
  private configure(view: View, revision: number, showsWholeRobot: boolean): void {
    const isCurrent = this.revision === revision;
    this.configuredView = view;
    this.revision = revision;
    this.showsWholeRobot = showsWholeRobot;
    if (isCurrent) return;
    this.setAwaitingFirstFit(showsWholeRobot);
    this.view = copyView(view);
    this.changed.emit();
  }

  private setAwaitingFirstFit(isAwaiting: boolean): void {
    this.fittedContent = isAwaiting ? { target: "", box: null } : null;
    this.fittedMap = "";
  }

  private fitValues(box: Bounds, size: ViewSize): ViewValues {
    return this.controller.fit(this.view.values, transformBounds(box, this.target), size);
  }

  private change(view: View): void {
    this.fittedContent = null;
    this.fittedMap = null;
    this.setView(view);
  }

  private setView(view: View): void {
    this.view = view;
    this.changed.emit();
    this.timer ??= setTimeout(() => {
      this.timer = undefined;
      this.connection.send({ type: "view_changed", view: copyView(this.view) });
    }, ANNOUNCE_INTERVAL_MS);
  }

  private changeSaved(id: string, view: View): void {
    this.connection.send({ type: "change_saved_view", id, view });
  }

  private defaultsOf(cls: string): ViewValues {
    return this.classes.find((viewClass) => viewClass.cls === cls)?.defaults ?? controllerOf(cls).zero();
  }

  private clampToBounds(cls: string, values: ViewValues): ViewValues {
    const clampedValues: Record<string, PropertyValue> = {};
    for (const [path, value] of Object.entries(values)) {
      const property = findProperty(this.propertiesOf(cls), path);
      if (typeof value !== "number") clampedValues[path] = value;
      else if (Number.isFinite(value)) {
        clampedValues[path] = Math.min(Math.max(value, property?.minimum ?? -Infinity), property?.maximum ?? Infinity);
      }
    }
    return clampedValues;
  }
}

function copyView(view: View): View {
  return { ...view, values: { ...view.values } };
}

function findProperty(properties: readonly Property[], id: string): Property | undefined {
  for (const property of properties) {
    if (property.id === id) return property;
    const match = findProperty(property.children, id);
    if (match) return match;
  }
  return undefined;
}
