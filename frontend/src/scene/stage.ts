import { Box3, Matrix4, Raycaster, Vector2, Vector3 } from "three";
import type { DisplayState } from "../state/displays";
import type { Session } from "../state/session";
import type { Drawing } from "./displays/drawing";
import { Pacing } from "./displays/pacing";
import { DRAWINGS } from "./displays/registry";
import { RobotModelDrawing } from "./displays/robot-model";
import { FocalShape } from "./focal-shape";
import { FrameLoop } from "./frame-loop";
import { MeshLibrary } from "./meshes/mesh-library";
import { Outline } from "./outline";
import { framePose } from "./pose";
import { Viewport } from "./viewport";

interface DrawnDisplay {
  display: DisplayState;
  drawing: Drawing;
  pacing: Pacing;
}

/** The 3-D view: one drawing for each display, drawn when something changed. */
export class Stage {
  readonly viewport: Viewport;
  readonly loop = new FrameLoop((fine) => this.draw(fine));
  private readonly meshes = new MeshLibrary();
  private readonly drawings = new Map<string, DrawnDisplay>();
  private readonly outline: Outline;
  private readonly focalShape = new FocalShape();
  private robotSettled = false;

  constructor(
    container: HTMLElement,
    private readonly session: Session,
  ) {
    // A resized canvas is empty until it is drawn: at once, or it would flicker.
    this.viewport = new Viewport(container, () => this.draw(false));
    this.outline = new Outline(this.viewport);
    this.viewport.scene.add(this.focalShape.root);
    this.listen();
    this.matchDisplays();
  }

  /** True once a frame with the robot, its meshes and its transforms was drawn. */
  get ready(): boolean {
    return this.robotSettled;
  }

  /** Visuals of all robots drawn in the last frame. */
  get visualsDrawn(): number {
    let count = 0;
    for (const { drawing } of this.drawings.values()) {
      if (drawing instanceof RobotModelDrawing) count += drawing.visualsDrawn;
    }
    return count;
  }

  set focalShapeVisible(visible: boolean) {
    if (this.focalShape.root.visible === visible) return;
    this.focalShape.root.visible = visible;
    this.loop.invalidate();
  }

  /** Selects the link at a place of the canvas (pixels from its upper left corner), or nothing. */
  pick(x: number, y: number): void {
    const { clientWidth, clientHeight } = this.viewport.canvas;
    const ray = new Raycaster();
    ray.setFromCamera(
      new Vector2((x / clientWidth) * 2 - 1, 1 - (y / clientHeight) * 2),
      this.viewport.camera,
    );
    let best: { display: string; link: string; distance: number } | null = null;
    for (const [id, { display, drawing }] of this.drawings) {
      const hit = display.enabled ? drawing.pick?.(ray) : null;
      if (hit && (best === null || hit.distance < best.distance)) best = { display: id, ...hit };
    }
    const name = best?.link;
    const link = best && this.session.robots.get(best.display)?.links.find((each) => each.name === name);
    this.session.selection.select(best && link ? { display: best.display, link } : null);
  }

  /** Moves the focal point to the middle of the selected link, or of all robots when none is selected. */
  focusSelected(): void {
    const { selected } = this.session.selection;
    const box = new Box3();
    for (const [id, { drawing }] of this.drawings) {
      if (selected && selected.display !== id) continue;
      const objects = selected ? drawing.objectsOf?.(selected.link.name) : drawing.pick && [drawing.root];
      for (const object of objects ?? []) box.expandByObject(object);
    }
    const pose = new Matrix4();
    const { frames } = this.session;
    if (box.isEmpty() && selected && framePose(frames, frames.row(selected.link.frame), pose)) {
      // A link that draws nothing is where its frame is.
      box.expandByPoint(new Vector3().setFromMatrixPosition(pose));
    }
    if (box.isEmpty()) return;
    const middle = box.getCenter(new Vector3());
    const [x, y, z] = this.session.view.targetPosition();
    this.session.view.update({ focal_point: [middle.x - x, middle.y - y, middle.z - z] });
  }

  private listen(): void {
    const { session, loop } = this;
    const { displays, frames, view, selection } = session;
    const invalidate = (): void => loop.invalidate();
    displays.treeChanged.on(() => this.matchDisplays());
    displays.rowsChanged.on((display) => this.propertiesChanged(display));
    displays.valueChanged.on(({ display }) => {
      if (display) this.propertiesChanged(display);
      else this.globalOptionsChanged();
    });
    displays.enabledChanged.on((display) => this.propertiesChanged(display));
    frames.tableChanged.on(invalidate);
    frames.posesChanged.on(invalidate);
    view.changed.on(invalidate);
    selection.changed.on(invalidate);
  }

  private matchDisplays(): void {
    const { displays } = this.session.displays;
    for (const [id, { display, drawing, pacing }] of this.drawings) {
      if (displays.includes(display)) continue;
      drawing.root.removeFromParent();
      pacing.restart();
      drawing.dispose();
      this.drawings.delete(id);
    }
    for (const display of displays) {
      const known = this.drawings.get(display.id);
      const Drawing = DRAWINGS.get(display.cls);
      if (known) this.propertiesChanged(known.display);
      else if (Drawing && display.supported) {
        const { session, meshes } = this;
        const invalidate = (): void => this.loop.invalidate();
        const drawing = new Drawing({ display, session, meshes, invalidate });
        this.drawings.set(display.id, { display, drawing, pacing: new Pacing(invalidate) });
        this.viewport.scene.add(drawing.root);
      }
    }
    this.globalOptionsChanged();
  }

  private propertiesChanged(display: DisplayState): void {
    const drawn = this.drawings.get(display.id);
    drawn?.drawing.propertiesChanged();
    drawn?.pacing.restart();
    this.loop.invalidate();
  }

  private globalOptionsChanged(): void {
    const options = this.session.displays.globalOptions;
    this.viewport.background = options.text("#303030", "Background Color");
    this.loop.rate = options.number(30, "Frame Rate");
    this.loop.invalidate();
  }

  private draw(fine: boolean): void {
    const { view, selection } = this.session;
    this.viewport.aim(view);
    this.focalShape.place(view);
    let settled = true;
    const now = performance.now();
    for (const { display, drawing, pacing } of this.drawings.values()) {
      drawing.root.visible = display.enabled;
      if (!display.enabled) continue;
      if (pacing.due(now, 1000 * display.rows.number(0, "Update Interval"))) drawing.update();
      settled &&= drawing.settled?.() ?? true;
    }
    const { selected } = selection;
    const owner = selected && this.drawings.get(selected.display);
    const objects = selected && owner?.display.enabled ? owner.drawing.objectsOf?.(selected.link.name) : null;
    this.outline.set(objects ?? []);
    this.viewport.render(fine);
    this.outline.render();
    this.robotSettled ||= settled && this.visualsDrawn > 0;
  }
}
