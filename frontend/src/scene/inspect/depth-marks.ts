import { Color, Matrix4, Vector3, type Object3D } from "three";
import { CopyBatch } from "../objects/copy-batch";
import { createAxes, createSphere } from "../objects/geometries";
import { LabelBatch } from "../objects/label-batch";
import { computeLinkPose, type InspectedRobot } from "./inspected-robot";

/** Sizes in units of the robot's mark size. */
const AXES_SIZE = 0.42;
const SPHERE_SIZE = 0.11;
const LABEL_SIZE = 0.17;
/** The size of a frame relative to its parent's, and the minimum size. */
const SIZE_RATIO = 0.88;
const MIN_SIZE = 0.3;
/** With more frames than this, only levels are written, not names. */
const MAX_NAMES = 60;
/** Hues advance by the golden ratio, so that consecutive levels differ. */
const HUE_STEP = 0.618;

/** The frames of links, each with a ball in the color of its level in the tree; deeper ones are smaller. */
export class DepthMarks {
  private readonly axes: CopyBatch;
  private readonly spheres: CopyBatch;
  private readonly labels = new LabelBatch();
  private levels: number[] = [];

  constructor(parent: Object3D) {
    this.axes = new CopyBatch(parent, createAxes(1, 0.06, 8), { isOverlay: true });
    this.spheres = new CopyBatch(parent, createSphere(12), { isOverlay: true });
    parent.add(this.labels.root);
  }

  /** Draws the frames down to the level `maxDepth`, or all for null; null for `robots` draws nothing. */
  update(robots: readonly InspectedRobot[] | null, maxDepth: number | null): void {
    const frames = (robots ?? []).flatMap((robot) =>
      [...robot.model.links.keys()].flatMap((link) => {
        const depth = robot.model.depthOf(link);
        return maxDepth === null || depth <= maxDepth ? [{ robot, link, depth }] : [];
      }),
    );
    const showsNames = frames.length <= MAX_NAMES;
    const labelOf = (depth: number, link: string): string => (showsNames ? `${depth} ${link}` : String(depth));
    this.axes.begin(frames.length);
    this.spheres.begin(frames.length);
    this.labels.begin(frames.reduce((sum, { depth, link }) => sum + labelOf(depth, link).length, 0));
    this.levels = [];
    const pose = new Matrix4();
    for (const { robot, link, depth } of frames) {
      if (!computeLinkPose(robot, link, pose)) continue;
      const size = robot.markSize * Math.max(MIN_SIZE, SIZE_RATIO ** depth);
      this.labels.add(labelOf(depth, link), new Vector3().setFromMatrixPosition(pose), LABEL_SIZE * size, 0, 1);
      this.axes.add(pose.clone().scale(createUniformScale(AXES_SIZE * size)));
      this.spheres.add(pose.scale(createUniformScale(SPHERE_SIZE * size)), 0, 1, levelColorOf(depth));
      this.levels[depth] = (this.levels[depth] ?? 0) + 1;
    }
    for (const batch of [this.axes, this.spheres, this.labels]) batch.end();
  }

  /** Returns the number of frames drawn on each level. */
  inspect(): object {
    return Array.from(this.levels, (count) => count);
  }
}

/** Returns the color of a level of the tree, 0xrrggbb. */
function levelColorOf(depth: number): number {
  return new Color().setHSL((0.58 + depth * HUE_STEP) % 1, 0.85, 0.6).getHex();
}

function createUniformScale(size: number): Vector3 {
  return new Vector3(size, size, size);
}
