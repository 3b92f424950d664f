import { Box3, Group, type Camera, type Object3D } from "three";
import type { DisplayState } from "../state/displays";
import type { Session } from "../state/session";
import type { Theme, ThemeState } from "../state/theme";
import type { Bounds } from "../state/views/vector";
import type { PanelHost } from "./displays/display-panel";
import type { Drawing, DrawnScene } from "./displays/drawing";
import { Pacing } from "./displays/pacing";
import { DRAWINGS } from "./displays/registry";
import { listFramingPoints } from "./robot/surface-samples";
import { RobotModelDrawing } from "./displays/robot-model";
import { WorldDrawing } from "./displays/world";
import { Backdrop } from "./backdrop";
import { Flash } from "./flash";
import { FocalShape } from "./focal-shape";
import { setInitialView, boundsOf } from "./initial-view";
import { UncoveredArea } from "./uncovered-area";
import { FINEST_DETAIL, FrameLoop, type Detail } from "./frame-loop";
import { fitMaps } from "./map-look";
import { InspectLayer } from "./inspect/inspect-layer";
import { SERVER_FILES, type MeshFiles } from "./meshes/mesh-files";
import { MeshLibrary } from "./meshes/mesh-library";
import type { LodMeshes } from "./meshes/lod-meshes";
import { Outline } from "./outline";
import { Picker } from "./picker";
import type { Interaction } from "./picking";
import type { Lighting } from "./light";
import { RobotLight } from "./robot-light";
import { hasOwnBackground } from "./surroundings";
import { Viewport } from "./viewport";

/** The stage counts as ready after this time even if no link has a pose: some robots never get a transform. */
const POSE_TIMEOUT_MS = 5000;
const NOT_ANTIALIASED_DETAIL: Detail = { ...FINEST_DETAIL, isAntialiased: false };

interface DrawnDisplay {
  display: DisplayState;
  drawing: Drawing;
  pacing: Pacing;
}

/** The 3-D view, with one drawing for each display, drawn when something changed. */
export class Stage {
  readonly viewport: Viewport;
  readonly picker: Picker;
  readonly loop = new FrameLoop((detail) => this.draw(detail), true);
  private readonly meshes: MeshLibrary;
  private readonly drawings = new Map<string, DrawnDisplay>();
  private readonly outline: Outline;
  private readonly flash: Flash;
  private readonly inspectLayer: InspectLayer;
  private readonly focalShape = new FocalShape();
  /** Objects that only this view shows: handles, and the mark of the focal point. */
  readonly overlays = new Group();
  private interaction: Interaction = { isEnabled: false, hidesOthers: false };
  private readonly robotLight = new RobotLight();
  private readonly backdrop = new Backdrop();
  private hasRobotSettled = false;
  /** The displays that were still loading something in the last frame. */
  private loadingKey = "";
  /** The time when all meshes were drawn but no link had a pose. */
  private poselessSinceMs: number | null = null;
  /** The part of the canvas that nothing covers. */
  readonly uncoveredArea: UncoveredArea;

  constructor(
    private readonly container: HTMLElement,
    private readonly session: Session,
    private readonly panels: PanelHost,
    private readonly theme: ThemeState,
    files: MeshFiles = SERVER_FILES,
    lodMeshes: LodMeshes | null = null,
  ) {
    this.meshes = new MeshLibrary(session.meshProgress, files, lodMeshes);
    this.viewport = new Viewport(container, () => this.loop.redraw(NOT_ANTIALIASED_DETAIL));
    this.uncoveredArea = new UncoveredArea(this.viewport, () => this.computeRobotBounds(), () => this.viewport.aim(session.view), () => this.loop.invalidate());
    this.picker = new Picker(this.viewport, session, () => this.iterateEnabledDrawings());
    this.outline = new Outline(this.viewport);
    const invalidate = (): void => this.loop.invalidate();
    this.flash = new Flash(this.viewport, session, (display, link) => this.objectsOf(display, link), invalidate);
    this.inspectLayer = new InspectLayer(session, (display) => this.boundsOf(display), invalidate);
    session.displays.isLoading = ({ id }) => this.drawings.get(id)?.drawing.isSettled?.() === false;
    this.overlays.add(this.focalShape.root);
    this.viewport.scene.add(this.overlays, this.inspectLayer.root, this.robotLight.root, this.backdrop.root);
    this.listen();
    this.syncDrawings();
  }

  /** Whether robot or world, their meshes and transforms have been drawn, or transforms failed to arrive in time. */
  get isReady(): boolean {
    const startMs = this.poselessSinceMs;
    return this.hasRobotSettled || (startMs !== null && performance.now() - startMs > POSE_TIMEOUT_MS);
  }

  /** Whether the last frame shows the current state, so that no further frame is due. */
  get isSettled(): boolean {
    return this.loop.isSettled && ![...this.drawings.values()].some(({ pacing }) => pacing.isWaiting);
  }

  /** The number of visuals of all robots drawn in the last frame. */
  get visualsDrawn(): number {
    return this.listRobots().reduce((sum, robot) => sum + robot.visualsDrawn, 0);
  }

  /** Returns what a display draws, for tests. */
  inspect(display: string): object | null {
    return this.drawings.get(display)?.drawing.inspect?.() ?? null;
  }

  /** What is drawn of invisible properties, for tests. */
  get invisibleProperties(): object {
    return this.inspectLayer.inspect();
  }

  set isFocalShapeVisible(isVisible: boolean) {
    if (this.focalShape.isShown === isVisible) return;
    this.focalShape.isShown = isVisible;
    this.loop.invalidate();
  }

  /** Returns the scene as PNG, without marks of the selection and of camera motion. */
  async takeScreenshot(scale: number): Promise<Blob | null> {
    this.overlays.visible = false;
    const screenshot = this.viewport.takeScreenshot(scale);
    this.overlays.visible = true;
    this.draw(FINEST_DETAIL);
    return screenshot;
  }

  /** Whether a display has objects that the Interact tool can move. */
  get isInteractive(): boolean {
    return [...this.iterateEnabledDrawings()].some(([, drawing]) => "onPointer" in drawing);
  }

  /** Looks at the center of the selection, or of all selectable objects if nothing is selected. */
  focusSelected(): void {
    const center = this.picker.centerOfSelection();
    if (center) this.session.view.lookAt(center);
  }

  /** Fits the whole selection, or everything if nothing is selected, into view from the current direction. */
  fit(): void {
    const box = this.picker.computeSelectionBounds() ?? this.computeAllBounds();
    if (box) this.session.view.fit(box, this.uncoveredArea.centerView());
  }

  /** Fits all robots into view from the current direction. */
  fitRobots(): void {
    const box = this.computeSampledRobotBounds();
    if (box) this.session.view.fit(box, this.uncoveredArea.centerView());
  }

  /** Notifies the drawings of the state of the Interact tool. */
  setInteraction(interaction: Interaction): void {
    this.interaction = interaction;
    for (const { drawing } of this.drawings.values()) drawing.onInteractionChanged?.(interaction);
    this.loop.invalidate();
  }

  /** Returns the enabled displays by ID. */
  private *iterateEnabledDrawings(): Generator<readonly [string, Drawing]> {
    for (const [id, { display, drawing }] of this.drawings) if (display.isEnabled) yield [id, drawing];
  }

  private listen(): void {
    const { session, loop } = this;
    const { displays, frames, view, selection } = session;
    session.drawingPace.softwareRenderer = this.viewport.softwareRenderer;
    if (this.viewport.softwareRenderer !== null) loop.expectSlow();
    loop.judged.on((isLate) => session.drawingPace.countFrame(isLate));
    session.drawingPace.changed.on(() => {
      this.viewport.isSlow ||= session.drawingPace.isSlow;
      for (const display of displays.displays) this.onPropertiesChanged(display);
    });
    const invalidate = (): void => loop.invalidate();
    displays.treeChanged.on(() => this.syncDrawings());
    displays.rowsChanged.on((display) => this.onPropertiesChanged(display));
    displays.valueChanged.on(({ display }) => {
      if (display) this.onPropertiesChanged(display);
      else this.onGlobalOptionsChanged();
    });
    displays.enabledChanged.on((display) => this.onPropertiesChanged(display));
    session.data.received.on((data) => {
      const drawing = this.drawings.get(data.display);
      drawing?.drawing.onDataChanged?.(data);
      if (drawing?.display.isEnabled && !drawing.drawing.isElsewhere) loop.invalidate();
    });
    session.data.removed.on(({ display, key }) => {
      this.drawings.get(display)?.drawing.onDataRemoved?.(key);
      loop.invalidate();
    });
    frames.tableChanged.on(invalidate);
    frames.posesChanged.on(invalidate);
    view.changed.on(invalidate);
    selection.changed.on(() => this.onSelectionChanged());
    session.focus.hoverChanged.on(invalidate);
    session.time.displaysCleared.on(invalidate);
    const applyTheme = (theme: Theme): void => {
      this.backdrop.theme = theme;
      invalidate();
    };
    applyTheme(this.theme.theme);
    this.theme.changed.on(applyTheme);
  }

  private syncDrawings(): void {
    const { displays } = this.session.displays;
    for (const [id, { display, drawing, pacing }] of this.drawings) {
      if (displays.includes(display)) continue;
      drawing.root.removeFromParent();
      pacing.restart();
      drawing.dispose();
      this.drawings.delete(id);
    }
    for (const display of displays) {
      const existing = this.drawings.get(display.id);
      const Drawing = DRAWINGS.get(display.drawing);
      if (existing) this.onPropertiesChanged(existing.display);
      else if (Drawing && display.isSupported) {
        const { session, meshes, panels, container: overScene } = this;
        const invalidate = (): void => this.loop.invalidate();
        const showWithFrame = (show: () => void): void => this.loop.schedule(show);
        const getCamera = (): Camera => this.viewport.camera;
        const canAffordStudio = (): boolean => this.viewport.canAffordStudio;
        const drawing = new Drawing({ display, session, meshes, panels, overScene, invalidate, showWithFrame, getCamera, canAffordStudio });
        this.drawings.set(display.id, { display, drawing, pacing: new Pacing(invalidate) });
        this.viewport.scene.add(drawing.root);
        drawing.onInteractionChanged?.(this.interaction);
        for (const data of session.data.contentsOf(display.id)) drawing.onDataChanged?.(data);
      }
    }
    this.onGlobalOptionsChanged();
    this.onSelectionChanged();
    if (this.session.displays.isKnown) this.loop.release();
  }

  private onPropertiesChanged(display: DisplayState): void {
    const drawing = this.drawings.get(display.id);
    drawing?.drawing.onPropertiesChanged();
    drawing?.pacing.restart();
    this.loop.invalidate();
  }

  private onGlobalOptionsChanged(): void {
    const options = this.session.displays.globalOptions;
    this.viewport.background = this.backgroundColor;
    this.loop.rate = options.number(30, "Frame Rate");
    this.loop.invalidate();
  }

  private get backgroundColor(): string {
    return this.session.displays.globalOptions.text("#303030", "Background Color");
  }

  private draw(detail: Detail): void {
    const { view } = this.session;
    this.viewport.resolutionShare = detail.resolutionShare;
    fitMaps(this.iterateEnabledDrawings(), view, this.uncoveredArea);
    this.viewport.aim(view);
    this.focalShape.updatePose(view);
    const { lighting } = this;
    for (const robot of this.listRobots()) robot.light = lighting;
    let loadingKey = "";
    const now = performance.now();
    for (const { display, drawing, pacing } of this.drawings.values()) {
      drawing.root.visible = display.isEnabled;
      if (!display.isEnabled) continue;
      if (pacing.shouldUpdate(now, 1000 * display.rows.number(0, "Update Interval"))) drawing.update();
      if (drawing.isSettled?.() === false) loadingKey += ` ${display.id}`;
    }
    const isSettled = loadingKey === "";
    if (loadingKey !== this.loadingKey) {
      this.loadingKey = loadingKey;
      this.session.displays.statusChanged.emit(null);
    }
    this.hasRobotSettled ||= isSettled && [...this.listRobots(), ...this.listWorlds()].some((model) => model.hasPose);
    if (isSettled && this.session.robot !== null) this.poselessSinceMs ??= now;
    this.setInitialView(isSettled);
    const robotLighting = this.listWorlds().length > 0 ? "Camera" : lighting;
    const worldLight = this.listWorlds().find((world) => world.ownLight)?.ownLight;
    const ownLight = worldLight ?? this.robotLight.update(robotLighting, this.listRobots(), this.backgroundColor);
    this.backdrop.root.visible = this.session.displays.hasBackdrop && !hasOwnBackground(ownLight);
    this.viewport.applyLight(ownLight);
    this.inspectLayer.update();
    this.outline.set(this.listSelectedObjects());
    const isMoving = detail.isMoving && ownLight === null;
    if (isMoving) for (const [, drawing] of this.iterateEnabledDrawings()) drawing.simplify?.(this.viewport.drawnView);
    this.viewport.render(detail.isAntialiased);
    if (isMoving) for (const [, drawing] of this.iterateEnabledDrawings()) drawing.simplify?.(null);
    this.outline.render();
    this.flash.render();
    this.drawOwnPanels();
  }

  /** The lighting of robots; a robot in a world is lit as the world's display specifies. */
  private get lighting(): Lighting {
    const [world] = this.listWorlds();
    if (world) return world.lighting === "Soft" ? "Soft" : "Camera";
    const light = this.session.displays.globalOptions.text("Camera", "Light");
    if (light === "Camera") return "Camera";
    return light === "Studio" || this.viewport.canAffordStudio ? "Studio" : "Soft";
  }

  /** Places the camera if no user has: in front of the robot's visible parts, or into a world once it is complete. */
  private setInitialView(isSettled: boolean): void {
    const { view } = this.session;
    const [robots, [world]] = [this.listRobots(), this.listWorlds()];
    if (robots.length === 0 && world?.hasPose) {
      if (isSettled) setInitialView(world, view, this.viewport.size);
    } else {
      const visibleKey = robots.flatMap((robot) => robot.visibleKey || []).join(";");
      const needsFit = view.awaitsFit(visibleKey);
      if (visibleKey === "" || !(needsFit || view.awaitsSize)) return;
      const box = this.computeSampledRobotBounds();
      if (box && needsFit) view.fitFirst(box, this.uncoveredArea.centerView(), visibleKey);
      if (box && isSettled) view.reportSize(box, Math.min(...robots.map((robot) => robot.computeGround())));
    }
    this.viewport.aim(view);
  }

  private listRobots(): RobotModelDrawing[] {
    return [...this.iterateEnabledDrawings()].flatMap(([, drawing]) => (drawing instanceof RobotModelDrawing ? [drawing] : []));
  }

  /** The simulated world, if one is shown, with the display's ID. */
  get world(): { id: string; drawing: WorldDrawing } | null {
    for (const [id, drawing] of this.iterateEnabledDrawings()) if (drawing instanceof WorldDrawing) return { id, drawing };
    return null;
  }

  private listWorlds(): WorldDrawing[] {
    return [...this.iterateEnabledDrawings()].flatMap(([, drawing]) => (drawing instanceof WorldDrawing ? [drawing] : []));
  }

  private computeRobotBounds(): Bounds | null {
    return boundsOf(this.listRobots().reduce((sum, robot) => sum.union(robot.computeBounds()), new Box3()));
  }

  /** Returns the bounding box of all robots, with sample points of their surfaces. */
  private computeSampledRobotBounds(): Bounds | null {
    const box = this.computeRobotBounds();
    const points = this.listRobots().flatMap((robot) => robot.visibleMeshes.flatMap((mesh) => listFramingPoints(mesh)));
    return box && points.length > 0 ? { ...box, points } : box;
  }

  /** Returns the bounding box of robots and the world's models; of all selectable objects if there are none. */
  private computeAllBounds(): Bounds | null {
    const worldBounds = this.listWorlds().reduce((sum, world) => sum.union(world.computeBoundsByKind().world), new Box3());
    const allBounds = this.listRobots().reduce((sum, robot) => sum.union(robot.computeBounds()), worldBounds);
    return boundsOf(allBounds) ?? this.picker.computeAllBounds();
  }

  /** Draws the displays that show the scene in their own panels. */
  private drawOwnPanels(): void {
    const { renderer, scene } = this.viewport;
    const view: DrawnScene = { renderer, scene, background: this.backgroundColor, drawOnly: (accepts, draw) => this.drawOnly(accepts, draw) };
    for (const { display, drawing } of this.drawings.values()) if (display.isEnabled) drawing.afterFrame?.(view);
  }

  private drawOnly(accepts: (display: DisplayState) => boolean, draw: () => void): void {
    const decorations = [this.overlays, this.backdrop.root, this.robotLight.root].filter((object) => object.visible);
    for (const decoration of decorations) decoration.visible = false;
    for (const { display, drawing } of this.drawings.values()) {
      drawing.root.visible = display.isEnabled && accepts(display);
    }
    draw();
    for (const { display, drawing } of this.drawings.values()) drawing.root.visible = display.isEnabled;
    for (const decoration of decorations) decoration.visible = true;
  }

  private onSelectionChanged(): void {
    const keys = new Map<string, Set<string>>();
    for (const { display, key } of this.session.selection.items) {
      keys.set(display, (keys.get(display) ?? new Set<string>()).add(key));
    }
    const noKeys: ReadonlySet<string> = new Set();
    for (const [id, { drawing }] of this.drawings) drawing.highlight?.(keys.get(id) ?? noKeys);
    this.loop.invalidate();
  }

  private listSelectedObjects(): Object3D[] {
    const objects: Object3D[] = [];
    for (const { display, key } of this.session.selection.items) objects.push(...this.objectsOf(display, key));
    const { hoveredElement } = this.session.focus;
    const link = hoveredElement && this.session.focus.linkOf(hoveredElement);
    if (hoveredElement && link !== null && link !== undefined) objects.push(...this.objectsOf(hoveredElement.display, link));
    return objects;
  }

  private objectsOf(display: string, key: string): readonly Object3D[] {
    const drawing = this.drawings.get(display);
    return (drawing?.display.isEnabled && drawing.drawing.objectsOf?.(key)) || [];
  }

  /** Returns the bounding box of a display's objects, in the fixed frame, m. */
  boundsOf(display: string): Box3 {
    const drawing = this.drawings.get(display);
    return drawing ? new Box3().expandByObject(drawing.drawing.root) : new Box3();
  }
}
