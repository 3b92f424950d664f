import { Matrix4, Quaternion, Vector3, type Box3, type Object3D } from "three";
import type { JointScene, LinkInertia, RobotScene } from "../../protocol";
import type { PropertyNode, PropertyRows } from "../../state/properties";
import { poseAlongX, ArrowBatch } from "../objects/arrow-batch";
import { AxesBatch } from "../objects/axes-batch";
import { CopyBatch } from "../objects/copy-batch";
import { createSphere, createCube } from "../objects/geometries";

const AXES_LENGTH_M = 0.1;
const AXES_RADIUS_M = 0.01;
const AXIS_ARROW = { shaftLength: 0.15, shaftDiameter: 0.05, headLength: 0.05, headDiameter: 0.08 };
const AXIS_COLOR = 0x00cc00;
const MASS_COLOR = 0xff0000;
/** The density of lead, kg/m3, from which RViz computes the spheres for a link's mass. */
const LEAD_DENSITY_KG_PER_M3 = 11340;
const ONE = new Vector3(1, 1, 1);

/** Returns the pose at which a link is drawn; null until it has a transform. */
export type FindLinkPose = (link: string) => Matrix4 | null;

/** What RViz draws in addition to a robot's shapes: axes of links and joints, joint axes, masses and inertias. */
export class RobotExtras {
  private readonly axes: AxesBatch;
  private readonly arrows: ArrowBatch;
  private readonly spheres: CopyBatch;
  private readonly boxes: CopyBatch;
  private readonly joints: readonly { joint: JointScene; origin: Matrix4 }[];
  private linkAxes: string[] = [];
  private jointAxes = new Set<string>();
  private jointArrows = new Set<string>();
  private masses: [string, LinkInertia][] = [];
  private inertias: [string, LinkInertia][] = [];

  constructor(
    private readonly scene: Pick<RobotScene, "links" | "joints">,
    parent: Object3D,
  ) {
    this.axes = new AxesBatch(parent, AXES_LENGTH_M, AXES_RADIUS_M);
    this.arrows = new ArrowBatch(parent);
    this.spheres = new CopyBatch(parent, createSphere(20));
    this.boxes = new CopyBatch(parent, createCube());
    this.joints = scene.joints.map((joint) => ({ joint, origin: createJointOrigin(joint) }));
  }

  /** The number of marks of each kind drawn now. */
  get counts(): { axes: number; jointAxes: number; masses: number; inertias: number } {
    return {
      axes: this.axes.size,
      jointAxes: this.arrows.size,
      masses: this.spheres.size,
      inertias: this.boxes.size,
    };
  }

  /** Reads the properties that determine what is drawn. */
  readProperties(rows: PropertyRows): void {
    const links = new Map(rows.find("Links")?.children.map((row) => [row.name, row]));
    const shownLinks = this.scene.links.filter((link) => links.get(link.name)?.value !== false);
    const masses = shownLinks.flatMap((link): [string, LinkInertia][] => (link.inertia ? [[link.name, link.inertia]] : []));
    this.linkAxes = shownLinks.filter((link) => isChecked(links.get(link.name), "Show Axes")).map((link) => link.name);
    this.masses = rows.bool(false, "Mass Properties", "Mass") ? masses : [];
    this.inertias = rows.bool(false, "Mass Properties", "Inertia")
      ? masses.filter(([, { box }]) => box.length === 3)
      : [];
    const joints = (rows.find("Joints")?.children ?? []).filter((row) => row.value !== false);
    this.jointAxes = new Set(joints.filter((row) => isChecked(row, "Show Axes")).map((row) => row.name));
    this.jointArrows = new Set(joints.filter((row) => isChecked(row, "Show Joint Axis")).map((row) => row.name));
  }

  updatePoses(poseOf: FindLinkPose): void {
    this.placeAxes(poseOf);
    const [matrix, size] = [new Matrix4(), new Matrix4()];
    this.spheres.begin(this.masses.length);
    for (const [link, { mass, center }] of this.masses) {
      const pose = poseOf(link);
      if (!pose || mass <= 0) continue;
      const diameter = 2 * Math.cbrt((0.75 * mass) / (Math.PI * LEAD_DENSITY_KG_PER_M3));
      matrix.makeTranslation(new Vector3().fromArray(center)).premultiply(pose);
      this.spheres.add(matrix.multiply(size.makeScale(diameter, diameter, diameter)), 0, 1, MASS_COLOR);
    }
    this.spheres.end();
    this.boxes.begin(this.inertias.length);
    for (const [link, { center, box, quaternion }] of this.inertias) {
      const pose = poseOf(link);
      if (!pose) continue;
      const position = new Vector3().fromArray(center);
      matrix.compose(position, new Quaternion().fromArray(quaternion), new Vector3().fromArray(box));
      this.boxes.add(matrix.premultiply(pose), 0, 1, MASS_COLOR);
    }
    this.boxes.end();
  }

  expandBox(box: Box3): void {
    for (const batch of [this.axes, this.arrows, this.spheres, this.boxes]) batch.expandBox(box);
  }

  dispose(): void {
    for (const batch of [this.axes, this.arrows, this.spheres, this.boxes]) batch.dispose();
  }

  private placeAxes(poseOf: FindLinkPose): void {
    this.axes.begin(this.linkAxes.length + this.jointAxes.size);
    this.arrows.begin(this.jointArrows.size);
    for (const link of this.linkAxes) {
      const pose = poseOf(link);
      if (pose) this.axes.add(pose);
    }
    const matrix = new Matrix4();
    if (this.jointAxes.size + this.jointArrows.size > 0) {
      for (const { joint, origin } of this.joints) {
        const pose = poseOf(joint.parent);
        if (!pose) continue;
        if (this.jointAxes.has(joint.name)) this.axes.add(matrix.multiplyMatrices(pose, origin));
        if (!this.jointArrows.has(joint.name)) continue;
        poseAlongX(new Vector3(), new Vector3().fromArray(joint.axis), matrix).premultiply(origin).premultiply(pose);
        this.arrows.add(matrix, AXIS_ARROW, { color: AXIS_COLOR });
      }
    }
    this.axes.end();
    this.arrows.end();
  }
}

/** Returns a joint's frame in the frame of its parent link, at position zero. */
function createJointOrigin({ position, quaternion }: JointScene): Matrix4 {
  return new Matrix4().compose(new Vector3().fromArray(position), new Quaternion().fromArray(quaternion), ONE);
}

function isChecked(row: PropertyNode | undefined, name: string): boolean {
  return row?.children.find((child) => child.name === name)?.value === true;
}
