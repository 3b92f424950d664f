import { Group, Matrix4, Quaternion, Vector3 } from "three";
import { FrameFilter } from "./frame-filter";
import { LabelBatch } from "../objects/label-batch";
import { framePose } from "../pose";
import type { Drawing, DrawingContext } from "./drawing";
import { fadeForAge, type Fade } from "./fade";
import { FrameMarkers } from "./frame-markers";

const SHAFT_RADIUS = 0.01;
const HEAD_RADIUS = 0.04;
const HEAD_LENGTH = 0.1;
const NAME_HEIGHT = 0.1;
/** A frame this close to its parent gets no arrow, m. */
const SHORTEST_ARROW = 0.001;
/** Steps in which fading is drawn: a new frame for each, none in between. */
const FADE_STEPS = 32;
const ALONG_Z = new Vector3(0, 0, 1);

/** From this many frames on they are drawn with fewer corners. */
const MANY_FRAMES = 120;
const FINE_SEGMENTS = 12;
const COARSE_SEGMENTS = 5;

/** rviz_default_plugins/TF: axes, arrows to the parents and names of all frames, each kind in one draw call. */
export class TfDrawing implements Drawing {
  readonly root = new Group();
  private readonly markers = new FrameMarkers(this.root, FINE_SEGMENTS);
  private readonly names = new LabelBatch();
  private readonly forget: (() => void)[];
  private filter = new FrameFilter("", "");
  private hidden = new Set<string>();
  private ageing = "";

  constructor(private readonly context: DrawingContext) {
    this.root.add(this.names.root);
    const { frames } = context.session;
    this.forget = [frames.agesChanged.on(() => this.agesChanged())];
    this.propertiesChanged();
  }

  propertiesChanged(): void {
    const { rows } = this.context.display;
    this.filter = new FrameFilter(rows.text("", "Filter (whitelist)"), rows.text("", "Filter (blacklist)"));
    const frames = rows.find("Frames")?.children ?? [];
    this.hidden = new Set(frames.filter((row) => row.value === false).map((row) => row.name));
  }

  update(): void {
    const { rows } = this.context.display;
    const scale = rows.number(1, "Marker Scale");
    const visible = this.visibleFrames();
    const [pose, size] = [new Matrix4(), new Matrix4().makeScale(scale, scale, scale)];
    const at = new Vector3();
    const { frames } = this.context.session;
    const showAxes = rows.bool(true, "Show Axes");
    const showNames = rows.bool(false, "Show Names");
    this.markers.refine(visible.length > MANY_FRAMES ? COARSE_SEGMENTS : FINE_SEGMENTS);
    const { axes } = this.markers;
    axes.begin(visible.length);
    this.names.begin(showNames ? visible.reduce((sum, [row]) => sum + (frames.names[row]?.length ?? 0), 0) : 0);
    for (const [row, fade] of visible) {
      if (!framePose(frames, row, pose)) continue;
      if (showAxes) axes.add(pose.clone().multiply(size), fade.grey, fade.alpha);
      if (!showNames) continue;
      this.names.add(
        frames.names[row] ?? "",
        at.setFromMatrixPosition(pose),
        NAME_HEIGHT * scale,
        fade.grey,
        fade.alpha,
      );
    }
    axes.end();
    this.names.end();
    this.drawArrows(rows.bool(true, "Show Arrows") ? visible : [], scale);
    this.ageing = this.ageKey();
  }

  dispose(): void {
    for (const forget of this.forget) forget();
    this.markers.dispose();
    this.names.dispose();
  }

  private drawArrows(visible: readonly (readonly [number, Fade])[], scale: number): void {
    const { poses, parents } = this.context.session.frames;
    const { shafts, heads } = this.markers;
    const [from, to, along] = [new Vector3(), new Vector3(), new Vector3()];
    const turn = new Quaternion();
    const matrix = new Matrix4();
    shafts.begin(visible.length);
    heads.begin(visible.length);
    for (const [row, fade] of visible) {
      const parent = parents[row] ?? -1;
      if (!this.context.session.frames.has(parent)) continue;
      from.fromArray(poses, row * 7);
      to.fromArray(poses, parent * 7);
      const distance = along.subVectors(to, from).length();
      if (distance < SHORTEST_ARROW) continue;
      turn.setFromUnitVectors(ALONG_Z, along.divideScalar(distance));
      const head = distance < HEAD_LENGTH * scale ? HEAD_LENGTH * scale * distance : HEAD_LENGTH * scale;
      const shaft = distance - head;
      matrix.compose(from, turn, new Vector3(SHAFT_RADIUS * scale, SHAFT_RADIUS * scale, shaft));
      shafts.add(matrix, fade.grey, fade.alpha);
      matrix.compose(
        from.addScaledVector(along, shaft),
        turn,
        new Vector3(HEAD_RADIUS * scale, HEAD_RADIUS * scale, head),
      );
      heads.add(matrix, fade.grey, fade.alpha);
    }
    shafts.end();
    heads.end();
  }

  private visibleFrames(): (readonly [number, Fade])[] {
    const { frames } = this.context.session;
    const timeout = this.context.display.rows.number(15, "Frame Timeout");
    const result: (readonly [number, Fade])[] = [];
    frames.names.forEach((name, row) => {
      if (!frames.has(row) || this.hidden.has(name) || !this.filter.accepts(name)) return;
      const fade = fadeForAge(frames.ages[row] ?? 0, timeout);
      if (fade.alpha > 0) result.push([row, fade]);
    });
    return result;
  }

  /** Only frames that look another age ask for a drawing. */
  private agesChanged(): void {
    if (this.context.display.enabled && this.ageKey() !== this.ageing) this.context.invalidate();
  }

  private ageKey(): string {
    const { ages } = this.context.session.frames;
    const timeout = this.context.display.rows.number(15, "Frame Timeout");
    const steps: number[] = [];
    ages.forEach((age, row) => {
      if (age <= timeout / 3) return;
      const { grey, alpha } = fadeForAge(age, timeout);
      steps.push(row, Math.round((grey - alpha) * FADE_STEPS));
    });
    return steps.join();
  }
}
