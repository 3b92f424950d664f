import { Mesh, MeshBasicMaterial, type BufferGeometry } from "three";
import { isShape, type NewKind, type Placement } from "../../state/modeling/shapes";
import { unitBox, unitCylinder, unitSphere } from "../objects/geometries";
import { extrudePolygons } from "../objects/world-geometries";
import { createEntityMatrix } from "./entity-pose";

/** The size of the disc on the ground for entities without a shape of their own, m. */
const DISC_SIZE_M = [0.2, 0.2, 0.01] as const;

/** A translucent preview of the entity that is about to be added to the world. */
export class Ghost {
  readonly root = new Mesh<BufferGeometry, MeshBasicMaterial>(
    unitBox,
    new MeshBasicMaterial({ color: 0x58a6ff, transparent: true, opacity: 0.45, depthWrite: false }),
  );

  private readonly wedge = extrudePolygons([[-0.5, -0.5, 0.5, -0.5, 0.5, 0.5]], 1).translate(0, 0, -0.5).rotateX(Math.PI / 2);

  constructor() {
    this.root.visible = this.root.matrixAutoUpdate = false;
  }

  /** Shows the preview at a placement; null hides it. */
  show(kind: NewKind, placement: Placement | null): void {
    this.root.visible = placement !== null;
    if (!placement) return;
    const { pose, size } = placement;
    const [x = 0, y = 0, z = 0] = isShape(kind) ? size : DISC_SIZE_M;
    this.root.geometry = this.geometryOf(kind);
    const scale = kind === "sphere" ? ([x, x, x] as const) : kind === "cylinder" ? ([x, x, y] as const) : ([x, y, z] as const);
    this.root.matrix.copy(createEntityMatrix(isShape(kind) ? pose : [...pose.slice(0, 2), 0, 0, 0, 0]));
    this.root.matrix.scale(this.root.scale.set(...scale));
    this.root.matrixWorldNeedsUpdate = true;
  }

  hide(): void {
    this.root.visible = false;
  }

  private geometryOf(kind: NewKind): BufferGeometry {
    if (kind === "ramp") return this.wedge;
    if (kind === "sphere") return unitSphere;
    return kind === "box" || kind === "wall" ? unitBox : unitCylinder;
  }
}
