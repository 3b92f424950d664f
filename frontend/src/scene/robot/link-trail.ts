import { Vector3, type Matrix4, type Object3D } from "three";
import { WideLines } from "../objects/wide-lines";

const LENGTH_M = 2;
const MAX_POINT_COUNT = 100;
const WIDTH_M = 0.01;
const COLOR = 0x008080;

/** The ribbon behind a link: the last 2 m of its path in 100 points. */
export class LinkTrail {
  private readonly ribbon = new WideLines();
  /** The points, newest first; the first one moves with the link. */
  private points: Vector3[] = [];

  constructor(world: Object3D) {
    world.add(this.ribbon.root);
    this.ribbon.setStyle(COLOR, 1, WIDTH_M);
  }

  follow(pose: Matrix4): void {
    const position = new Vector3().setFromMatrixPosition(pose);
    const [newestPoint, previousPoint] = this.points;
    if (newestPoint?.equals(position)) return;
    if (!newestPoint || !previousPoint || newestPoint.distanceTo(previousPoint) >= LENGTH_M / MAX_POINT_COUNT) this.points.unshift(position);
    else this.points[0] = position;
    this.points.length = Math.min(this.points.length, MAX_POINT_COUNT);
    this.ribbon.setStrips([new Float32Array(this.points.flatMap((point) => point.toArray()))]);
  }

  dispose(): void {
    this.ribbon.dispose();
  }
}
