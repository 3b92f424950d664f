import { BufferAttribute, Matrix4, Quaternion, Vector3, type BufferGeometry, type Object3D } from "three";
import type { LinkInertia } from "../../protocol";
import { CopyBatch } from "../objects/copy-batch";
import { createSphere, createCube } from "../objects/geometries";
import { LabelBatch } from "../objects/label-batch";
import { computeLinkPose, type InspectedRobot } from "./inspected-robot";
import { VertexStream } from "./vertex-stream";

const PLAUSIBLE_COLOR = 0x4da3ff;
const IMPLAUSIBLE_COLOR = 0xff4d42;
const TOTAL_COLOR = 0xffd23c;
const BOX_ALPHA = 0.3;
/** Sizes of marks in units of the robot's mark size. */
const SPHERE_SIZE = 0.16;
const TOTAL_SPHERE_SIZE = 0.3;
const LABEL_SIZE = 0.2;
/**
 * An ellipsoid with the inertia of a box has semi-axes of this share of the box's edges: m/5 (b² + c²) = m/12 (B² +
 * C²).
 */
const ELLIPSOID_RATIO = Math.sqrt(5 / 12);
/** The corners of a unit cube, in pairs that form its edges. */
const CUBE_EDGES = createCubeEdges();

/** The kinds of marks to draw. */
export interface MassMarkChoice {
  centers: boolean;
  boxes: boolean;
  ellipsoids: boolean;
}

/** Centers of mass as balls in black and white, and inertias as boxes and ellipsoids; implausible ones are red. */
export class MassMarks {
  private readonly spheres: CopyBatch;
  private readonly boxes: CopyBatch;
  private readonly ellipsoids: CopyBatch;
  private readonly edges: VertexStream;
  private readonly labels = new LabelBatch();
  /** The centers of mass of whole robots, in the fixed frame. */
  private totals: Vector3[] = [];

  constructor(parent: Object3D) {
    this.boxes = new CopyBatch(parent, createCube(), { isOverlay: true });
    this.ellipsoids = new CopyBatch(parent, createSphere(24), { isOverlay: true });
    this.edges = new VertexStream(parent, "lines");
    this.spheres = new CopyBatch(parent, paintQuarters(createSphere(16)), { isOverlay: true });
    parent.add(this.labels.root);
  }

  update(robots: readonly InspectedRobot[], choice: MassMarkChoice): void {
    const linkCount = robots.reduce((sum, { model }) => sum + model.links.size, 0);
    const hasChoice = choice.centers || choice.boxes || choice.ellipsoids;
    const labelLength = robots.flatMap((robot) => [...robot.implausibleLinks]).reduce((sum, name) => sum + name.length + 2, 0);
    this.boxes.begin(choice.boxes ? linkCount : 0);
    this.ellipsoids.begin(choice.ellipsoids ? linkCount : 0);
    this.spheres.begin(choice.centers ? linkCount + robots.length : 0);
    this.labels.begin(hasChoice ? labelLength : 0);
    this.edges.begin();
    this.totals = [];
    if (hasChoice) for (const robot of robots) this.addRobot(robot, choice);
    for (const batch of [this.boxes, this.ellipsoids, this.spheres, this.edges, this.labels]) batch.end();
  }

  inspect(): object {
    return {
      centers: this.spheres.size,
      boxes: this.boxes.size,
      ellipsoids: this.ellipsoids.size,
      totals: this.totals.map((total) => total.toArray()),
    };
  }

  private addRobot(robot: InspectedRobot, choice: MassMarkChoice): void {
    const pose = new Matrix4();
    const [sum, center] = [new Vector3(), new Vector3()];
    let mass = 0;
    for (const link of robot.model.links.values()) {
      if (!computeLinkPose(robot, link.name, pose)) continue;
      const isImplausible = robot.implausibleLinks.has(link.name);
      const { inertia } = link;
      center.fromArray(inertia?.center ?? [0, 0, 0]).applyMatrix4(pose);
      if (isImplausible) this.labels.add(`! ${link.name}`, center, LABEL_SIZE * robot.markSize, 0, 1);
      if (!inertia) continue;
      this.addLink(inertia, pose, center, isImplausible ? IMPLAUSIBLE_COLOR : PLAUSIBLE_COLOR, robot.markSize, choice);
      sum.addScaledVector(center, inertia.mass);
      mass += inertia.mass;
    }
    if (!(mass > 0) || !choice.centers) return;
    const total = sum.divideScalar(mass);
    this.totals.push(total);
    this.spheres.add(scalePose(pose.identity().setPosition(total), TOTAL_SPHERE_SIZE * robot.markSize), 0, 1, TOTAL_COLOR);
  }

  private addLink(
    inertia: LinkInertia,
    pose: Matrix4,
    center: Vector3,
    color: number,
    markSize: number,
    choice: MassMarkChoice,
  ): void {
    if (choice.centers && inertia.mass !== 0) {
      const centerColor = color === PLAUSIBLE_COLOR ? 0xffffff : color;
      this.spheres.add(scalePose(pose.clone().setPosition(center), SPHERE_SIZE * markSize), 0, 1, centerColor);
    }
    const [a = 0, b = 0, c = 0] = inertia.box;
    if (inertia.box.length === 0) return;
    const [qx = 0, qy = 0, qz = 0, qw = 1] = inertia.quaternion;
    const size = new Vector3(a, b, c);
    const axes = new Matrix4().compose(center, new Quaternion(), ONE);
    axes.multiply(new Matrix4().extractRotation(pose)).multiply(createRotation(qx, qy, qz, qw));
    if (choice.boxes) {
      const box = axes.clone().scale(size);
      this.boxes.add(box, 0, BOX_ALPHA, color);
      this.edges.setLook(color);
      this.edges.add(...CUBE_EDGES.map((corner) => corner.clone().applyMatrix4(box)));
    }
    // The diameters are twice the semi-axes, and the ball that is scaled has a diameter of one.
    if (choice.ellipsoids) this.ellipsoids.add(axes.scale(size.multiplyScalar(2 * ELLIPSOID_RATIO)), 0, BOX_ALPHA, color);
  }
}

const ONE = new Vector3(1, 1, 1);

function scalePose(pose: Matrix4, size: number): Matrix4 {
  return pose.scale(new Vector3(size, size, size));
}

function createRotation(x: number, y: number, z: number, w: number): Matrix4 {
  return new Matrix4().makeRotationFromQuaternion(new Quaternion(x, y, z, w));
}

/** Paints a ball with the symbol of a center of mass: quarters in black and white. */
function paintQuarters(sphere: BufferGeometry): BufferGeometry {
  const triangles = sphere.toNonIndexed();
  const [positions, colors] = [triangles.getAttribute("position"), triangles.getAttribute("color")];
  for (let i = 0; i < positions.count; i += 3) {
    const center = [0, 1, 2].map((axis) => [0, 1, 2].reduce((sum, j) => sum + positions.getComponent(i + j, axis), 0));
    const isDark = center.filter((component) => component < 0).length % 2 === 1;
    const gray = isDark ? 0.12 : 1;
    for (let j = 0; j < 3; j++) colors.setXYZ(i + j, gray, gray, gray);
  }
  const index = Uint32Array.from({ length: positions.count }, (_, i) => i);
  return triangles.setIndex(new BufferAttribute(index, 1));
}

function createCubeEdges(): Vector3[] {
  const corners: Vector3[] = [];
  for (const axis of [0, 1, 2]) {
    for (const [u, v] of [
      [-0.5, -0.5],
      [-0.5, 0.5],
      [0.5, -0.5],
      [0.5, 0.5],
    ] as const) {
      for (const coordinate of [-0.5, 0.5]) {
        const corner = new Vector3();
        corner.setComponent(axis, coordinate).setComponent((axis + 1) % 3, u).setComponent((axis + 2) % 3, v);
        corners.push(corner);
      }
    }
  }
  return corners;
}
