import { Vector3, type Matrix4, type Object3D } from "three";
import { WideLines } from "../objects/wide-lines";

const LENGTH = 2;
const ELEMENT_COUNT = 100;
const WIDTH = 0.01;
const COLOR = 0x008080;

/** The ribbon behind a link: the last 2 m of its path in 100 points. */
export class LinkTrail {
  private readonly ribbon = new WideLines();
  /** The points, newest first; the first one moves with the link. */
  private points: Vector3[] = [];

  constructor(world: Object3D) {
    world.add(this.ribbon.root);
    this.ribbon.setStyle(COLOR, 1, WIDTH);
  }

  follow(pose: Matrix4): void {
    const position = new Vector3().setFromMatrixPosition(pose);
    const [head, neck] = this.points;
    if (head?.equals(position)) return;
    if (!head || !neck || head.distanceTo(neck) >= LENGTH / ELEMENT_COUNT) this.points.unshift(position);
    else this.points[0] = position;
    this.points.length = Math.min(this.points.length, ELEMENT_COUNT);
    this.ribbon.setStrips([new Float32Array(this.points.flatMap((point) => point.toArray()))]);
  }

  dispose(): void {
    this.ribbon.dispose();
  }
}
