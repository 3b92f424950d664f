import { Matrix4, Vector3, type Box3 } from "three";
import { poseAlongX, ArrowBatch } from "../objects/arrow-batch";
import { WideLines } from "../objects/wide-lines";
import { ContentDrawing } from "./content-drawing";
import type { DrawingContext } from "./drawing";
import { poseAt } from "./styles";

/** The radius of a ring without effort, m, which is also added to the used share of the limit. */
const MIN_RADIUS_M = 0.05;
/** The points of a ring, which spans this many of 32 parts; the gap holds its arrow head. */
const POINT_COUNT = 30;
const RING_PART_COUNT = 32;

/** rviz_default_plugins/Effort: rings around the joints, larger and redder the closer the effort is to its limit. */
export class EffortDrawing extends ContentDrawing<"effort_rings"> {
  private readonly rings = new WideLines();
  private readonly heads = new ArrowBatch(this.root);

  constructor(context: DrawingContext) {
    super(context, "effort_rings");
    this.root.add(this.rings.root);
  }

  dispose(): void {
    this.rings.dispose();
    this.heads.dispose();
  }

  protected override inspectContents(): object {
    return { rings: this.heads.size, joints: this.latest?.joints ?? [], efforts: [...(this.latest?.efforts ?? [])] };
  }

  protected expandBox(box: Box3): void {
    this.rings.expandBox(box);
    this.heads.expandBox(box);
  }

  protected arrange(): void {
    const { rows } = this.context.display;
    const [scale, width, alpha] = [rows.number(1, "Scale"), rows.number(0.02, "Width"), rows.number(1, "Alpha")];
    const headShape = { shaftLength: 0, shaftDiameter: 2 * width, headLength: 2 * width, headDiameter: 4 * width };
    const contents = this.listPosedContents();
    const strips: Float32Array[] = [];
    const colors: Float32Array[] = [];
    const [pose, arrow] = [new Matrix4(), new Matrix4()];
    this.heads.begin(contents.reduce((sum, { content }) => sum + content.joints.length, 0));
    for (const { content } of contents) {
      content.joints.forEach((joint, i) => {
        if (!rows.bool(true, "Joints", joint)) return;
        const effort = content.efforts[i] ?? 0;
        const share = computeUsedShare(effort, content.limits[i] ?? 0) + MIN_RADIUS_M;
        const radius = MIN_RADIUS_M + (share * scale) / 2;
        const [r, g, b] = rainbowColorOf(share);
        poseAt(content.poses, i, pose);
        strips.push(createRing(pose, radius, Math.sign(effort)));
        colors.push(new Float32Array(Array.from({ length: POINT_COUNT }, () => [r, g, b, 1]).flat()));
        poseAlongX(new Vector3(0, radius, 0), new Vector3(effort > 0 ? -1 : 1, 0, 0), arrow);
        const color = (Math.round(r * 255) << 16) | (Math.round(g * 255) << 8) | Math.round(b * 255);
        this.heads.add(arrow.premultiply(pose), headShape, { color, alpha });
      });
    }
    this.heads.end();
    this.rings.setStrips(strips, colors);
    this.rings.setStyle(0xffffff, alpha, width);
  }
}

/** Returns the used share of an effort's limit, at most 1; for a joint without a limit, the effort itself. */
function computeUsedShare(effort: number, limit: number): number {
  return limit === 0 ? Math.abs(effort) : Math.min(Math.abs(effort) / limit, 1);
}

function createRing(pose: Matrix4, radius: number, direction: number): Float32Array {
  const strip = new Float32Array(POINT_COUNT * 3);
  const point = new Vector3();
  for (let i = 0; i < POINT_COUNT; i++) {
    const angle = (i * 2 * Math.PI) / RING_PART_COUNT;
    const x = radius * Math.sin(angle);
    point.set(direction < 0 ? -x : x, radius * Math.cos(angle), 0).applyMatrix4(pose).toArray(strip, i * 3);
  }
  return strip;
}

/** Returns RViz's color of an effort: from violet for 0 via blue, green and yellow to red for 1. */
export function rainbowColorOf(value: number): [number, number, number] {
  const hue = Math.min(1, Math.max(0, value)) * 5 + 1;
  const sector = Math.floor(hue);
  const fraction = hue - sector;
  const ramp = sector % 2 === 0 ? fraction : 1 - fraction;
  if (sector <= 1) return [ramp, 0, 1];
  if (sector === 2) return [0, ramp, 1];
  if (sector === 3) return [0, 1, ramp];
  if (sector === 4) return [ramp, 1, 0];
  return [1, ramp, 0];
}
