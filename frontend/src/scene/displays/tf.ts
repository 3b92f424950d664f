import { Box3, Group, Matrix4, Vector3, type Raycaster } from "three";
import { describePose } from "../described-pose";
import { poseAlongX } from "../objects/arrow-batch";
import { LabelBatch } from "../objects/label-batch";
import type { DescriptionRow, Hit, SelectionBox } from "../picking";
import { readFramePose } from "../pose";
import type { Drawing, DrawingContext } from "./drawing";
import { fadeForAge, type Fade } from "./fade";
import { FrameMarkers } from "./frame-markers";

const SHAFT_DIAMETER_M = 0.01;
const HEAD_DIAMETER_M = 0.04;
const SHAFT_COLOR = 0xcccc4d;
const HEAD_COLOR = 0xff1a99;
const HEAD_LENGTH_M = 0.1;
const NAME_HEIGHT_M = 0.1;
/** A frame closer to its parent than this gets no arrow, m. */
const MIN_ARROW_LENGTH_M = 0.001;
/** The number of steps in which fading is drawn, so that frames are requested only at steps. */
const FADE_STEP_COUNT = 32;

/** With more frames than this, axes and arrows have fewer segments. */
const MAX_FINE_FRAMES = 120;
const FINE_SEGMENT_COUNT = 12;
const COARSE_SEGMENT_COUNT = 5;

/** rviz_default_plugins/TF: axes, arrows to parents and names of all frames, each kind in one draw call. */
export class TfDrawing implements Drawing {
  readonly root = new Group();
  private readonly markers = new FrameMarkers(this.root, FINE_SEGMENT_COUNT);
  private readonly names = new LabelBatch();
  private readonly unsubscribe: (() => void)[];
  /** The frames that pass the server's filters and whose boxes are ticked. */
  private enabledFrames = new Set<string>();
  private drawnAgeKey = "";
  private nameCount = 0;
  /** The frames that have axes, in the order of the copies in the batch. */
  private axesNames: string[] = [];

  constructor(private readonly context: DrawingContext) {
    this.root.add(this.names.root);
    const { frames } = context.session;
    this.unsubscribe = [frames.agesChanged.on(() => this.onAgesChanged())];
    this.onPropertiesChanged();
  }

  onPropertiesChanged(): void {
    const { rows } = this.context.display;
    const frames = rows.find("Frames")?.children ?? [];
    this.enabledFrames = new Set(frames.filter((row) => row.value === true).map((row) => row.name));
  }

  update(): void {
    const { rows } = this.context.display;
    const scale = rows.number(1, "Marker Scale");
    const fades = this.listVisibleFrames();
    const [pose, size] = [new Matrix4(), new Matrix4().makeScale(scale, scale, scale)];
    const position = new Vector3();
    const { frames } = this.context.session;
    const showsAxes = rows.bool(true, "Show Axes");
    const showsNames = rows.bool(false, "Show Names");
    this.markers.setSegmentCount(fades.length > MAX_FINE_FRAMES ? COARSE_SEGMENT_COUNT : FINE_SEGMENT_COUNT);
    const { axes } = this.markers;
    axes.begin(fades.length);
    this.nameCount = 0;
    this.axesNames = [];
    this.names.begin(showsNames ? fades.reduce((sum, [row]) => sum + (frames.names[row]?.length ?? 0), 0) : 0);
    for (const [row, fade] of fades) {
      if (!readFramePose(frames, row, pose)) continue;
      if (showsAxes) {
        axes.add(pose.clone().multiply(size), fade.gray, fade.alpha);
        this.axesNames.push(frames.names[row] ?? "");
      }
      if (!showsNames) continue;
      this.nameCount += 1;
      this.names.add(
        frames.names[row] ?? "",
        position.setFromMatrixPosition(pose),
        NAME_HEIGHT_M * scale,
        fade.gray,
        fade.alpha,
      );
    }
    axes.end();
    this.names.end();
    this.drawArrows(rows.bool(true, "Show Arrows") ? fades : [], scale);
    this.drawnAgeKey = this.createAgeKey();
  }

  /** Picks frames by their axes, as in RViz. */
  pick(ray: Raycaster): Hit | null {
    const hit = this.markers.axes.pick(ray);
    const key = hit && this.axesNames[hit.copy];
    return hit && typeof key === "string" ? { key, distance: hit.distance, point: hit.point } : null;
  }

  pickBox(box: SelectionBox): readonly string[] {
    return this.axesNames.filter((name) => {
      const position = this.positionOf(name);
      return position !== null && box.hasPoint(position.x, position.y, position.z);
    });
  }

  positionOf(name: string): Vector3 | null {
    const pose = new Matrix4();
    const { frames } = this.context.session;
    return readFramePose(frames, frames.rowOf(name), pose) ? new Vector3().setFromMatrixPosition(pose) : null;
  }

  /** Returns a frame as RViz's Selection panel shows it. */
  describe(name: string): DescriptionRow | null {
    const { frames } = this.context.session;
    const row = frames.rowOf(name);
    const pose = new Matrix4();
    if (!readFramePose(frames, row, pose)) return null;
    const parent = frames.names[frames.parents[row] ?? -1] ?? "";
    return { name: `Frame ${name}`, children: [{ name: "Parent", value: parent }, ...describePose(pose)] };
  }

  /** Returns the number of axes, names and arrows drawn, and their bounds in the fixed frame. */
  inspect(): object {
    const box = new Box3();
    this.markers.axes.expandBox(box);
    this.markers.arrows.expandBox(box);
    const bounds = box.isEmpty() ? null : { min: box.min.toArray(), max: box.max.toArray() };
    const { axes, arrows } = this.markers;
    return { axes: axes.size, arrows: arrows.size, names: this.nameCount, bounds };
  }

  dispose(): void {
    for (const stop of this.unsubscribe) stop();
    this.markers.dispose();
    this.names.dispose();
  }

  private drawArrows(fades: readonly (readonly [number, Fade])[], scale: number): void {
    const { frames } = this.context.session;
    const { arrows } = this.markers;
    const [start, direction] = [new Vector3(), new Vector3()];
    const pose = new Matrix4();
    arrows.begin(fades.length);
    for (const [row, { gray, alpha }] of fades) {
      const parent = frames.parents[row] ?? -1;
      if (!frames.hasPose(parent)) continue;
      start.fromArray(frames.poses, row * 7);
      direction.fromArray(frames.poses, parent * 7).sub(start);
      const distance = direction.length();
      if (distance < MIN_ARROW_LENGTH_M) continue;
      const headLength = distance < HEAD_LENGTH_M * scale ? HEAD_LENGTH_M * scale * distance : HEAD_LENGTH_M * scale;
      const shape = {
        shaftLength: distance - headLength,
        shaftDiameter: SHAFT_DIAMETER_M * scale,
        headLength,
        headDiameter: HEAD_DIAMETER_M * scale,
      };
      arrows.add(poseAlongX(start, direction, pose), shape, { color: SHAFT_COLOR, headColor: HEAD_COLOR, alpha, gray });
    }
    arrows.end();
  }

  private listVisibleFrames(): (readonly [number, Fade])[] {
    const { frames } = this.context.session;
    const timeout = this.context.display.rows.number(15, "Frame Timeout");
    const visibleFrames: (readonly [number, Fade])[] = [];
    frames.names.forEach((name, row) => {
      if (!frames.hasPose(row) || !this.enabledFrames.has(name)) return;
      const fade = fadeForAge(frames.ages[row] ?? 0, timeout);
      if (fade.alpha > 0) visibleFrames.push([row, fade]);
    });
    return visibleFrames;
  }

  /** Requests a frame only if the fading of some frame changed by a step. */
  private onAgesChanged(): void {
    if (this.context.display.isEnabled && this.createAgeKey() !== this.drawnAgeKey) this.context.invalidate();
  }

  private createAgeKey(): string {
    const { ages } = this.context.session.frames;
    const timeout = this.context.display.rows.number(15, "Frame Timeout");
    const steps: number[] = [];
    ages.forEach((age, row) => {
      if (age <= timeout / 3) return;
      const { gray, alpha } = fadeForAge(age, timeout);
      steps.push(row, Math.round((gray - alpha) * FADE_STEP_COUNT));
    });
    return steps.join();
  }
}
