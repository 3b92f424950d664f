import { Matrix4, Vector3, type Box3 } from "three";
import { poseAlongX, ArrowBatch } from "../objects/arrow-batch";
import { WideLines } from "../objects/wide-lines";
import { ContentDrawing } from "./content-drawing";
import type { DrawingContext } from "./drawing";
import { colorOf } from "./styles";

/** RViz's arrow of unit length and width, which is scaled to draw vectors. */
const UNIT_ARROW = { shaftLength: 1, shaftDiameter: 0.1, headLength: 0.3, headDiameter: 0.2 };
/** The circle around an angular vector, in parts of 32; the gap holds its arrow head. */
const CIRCLE = { from: 4, to: 32, parts: 32 };
const CIRCLE_LINE_WIDTH = 0.05;
const CIRCLE_HEAD_SIZE = 0.1;

/**
 * rviz_default_plugins/TwistStamped, AccelStamped and Wrench: an arrow for each vector, and a circle around the angular
 * one.
 */
export class ScrewDrawing extends ContentDrawing<"screw"> {
  private readonly arrows = new ArrowBatch(this.root);
  private readonly circles = new WideLines();

  constructor(context: DrawingContext) {
    super(context, "screw");
    this.root.add(this.circles.root);
  }

  dispose(): void {
    this.arrows.dispose();
    this.circles.dispose();
  }

  protected override inspectContents(): object {
    return { arrows: this.arrows.size };
  }

  protected expandBox(box: Box3): void {
    this.arrows.expandBox(box);
    this.circles.expandBox(box);
  }

  protected arrange(): void {
    const { rows } = this.context.display;
    const [linear, angular] = rows.find("Force Color") ? ["Force", "Torque"] : ["Linear", "Angular"];
    const alpha = rows.number(1, "Alpha");
    const width = rows.number(0.5, "Arrow Width");
    const minLength = rows.bool(true, "Hide Small Values") ? width : 0;
    const linearColor = colorOf(rows, "#cc3333", `${linear} Color`);
    const angularColor = colorOf(rows, "#cccc33", `${angular} Color`);
    const scaleOf = (name: string): number => rows.number(2, `${name} Arrow Scale`);
    const contents = this.listPosedContents();
    const circles: Float32Array[] = [];
    const direction = new Vector3();
    this.arrows.begin(contents.length * 3);
    for (const { content, pose } of contents) {
      const linearLength = direction.fromArray(content.linear).length() * scaleOf(linear);
      if (linearLength > minLength) this.addVector(pose, direction, linearLength, width, { color: linearColor, alpha });
      const angularLength = direction.fromArray(content.angular).length() * scaleOf(angular);
      if (angularLength <= minLength) continue;
      this.addVector(pose, direction, angularLength, width, { color: angularColor, alpha });
      circles.push(this.addCircle(pose, direction, angularLength, width, { color: angularColor, alpha }));
    }
    this.arrows.end();
    this.circles.setStrips(circles);
    this.circles.setStyle(angularColor, alpha, width * CIRCLE_LINE_WIDTH);
  }

  private addVector(pose: Matrix4, direction: Vector3, length: number, width: number, look: ArrowLook): void {
    const matrix = poseAlongX(new Vector3(), direction, new Matrix4()).premultiply(pose);
    this.arrows.add(matrix.multiply(new Matrix4().makeScale(length, width, width)), UNIT_ARROW, look);
  }

  /** Returns the points of a circle around the middle of the vector, and adds its arrow head to the arrows. */
  private addCircle(pose: Matrix4, direction: Vector3, length: number, width: number, look: ArrowLook): Float32Array {
    // The vector is along x here, so that the circle turns from y to z.
    const matrix = poseAlongX(new Vector3(), direction, new Matrix4()).premultiply(pose);
    const radius = length / 4;
    const point = new Vector3();
    const strip = new Float32Array((CIRCLE.to - CIRCLE.from + 1) * 3);
    for (let i = CIRCLE.from; i <= CIRCLE.to; i++) {
      const angle = (i * 2 * Math.PI) / CIRCLE.parts;
      point.set(length / 2, radius * Math.cos(angle), radius * Math.sin(angle));
      point.applyMatrix4(matrix).toArray(strip, (i - CIRCLE.from) * 3);
    }
    const head = new Matrix4().makeBasis(new Vector3(0, 0, 1), new Vector3(1, 0, 0), new Vector3(0, 1, 0));
    const size = width * CIRCLE_HEAD_SIZE;
    this.arrows.add(
      head.setPosition(length / 2, radius, 0).premultiply(matrix),
      { shaftLength: 0, shaftDiameter: size, headLength: size, headDiameter: 2 * size },
      look,
    );
    return strip;
  }
}

interface ArrowLook {
  color: number;
  alpha: number;
}
