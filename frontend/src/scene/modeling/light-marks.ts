import { Group, Matrix4, Mesh, MeshBasicMaterial, OctahedronGeometry, type Raycaster } from "three";
import type { Modeling } from "../../state/modeling/modeling";
import { createEntityMatrix } from "./entity-pose";

/** The radius of a mark, m. */
const RADIUS_M = 0.12;
const [COLOR, SELECTED_COLOR] = [0xffd54a, 0x5db0ff];

/** Marks at the lights of the world, which would otherwise be invisible and could not be clicked. */
export class LightMarks {
  /** The group of the marks, in the world's frame. */
  readonly root = new Group();
  private readonly shape = new OctahedronGeometry(RADIUS_M);
  private readonly marks = new Map<string, Mesh<OctahedronGeometry, MeshBasicMaterial>>();

  constructor(private readonly modeling: Modeling) {
    this.root.matrixAutoUpdate = false;
  }

  /** Updates the marks of all lights; `displacements` are those of lights being dragged. */
  update(world: Matrix4, displacements: ReadonlyMap<string, Matrix4>): void {
    const { isActive, entities, selectedNames } = this.modeling;
    const lights = isActive ? entities.filter(({ kind }) => kind === "light") : [];
    for (const [name, mark] of this.marks) {
      if (lights.some((light) => light.name === name)) continue;
      mark.removeFromParent();
      mark.material.dispose();
      this.marks.delete(name);
    }
    for (const { name, pose } of lights) {
      const mark = this.marks.get(name) ?? this.createMark(name);
      mark.matrix.copy(createEntityMatrix(pose));
      mark.matrix.premultiply(displacements.get(name) ?? new Matrix4());
      mark.material.color.setHex(selectedNames.includes(name) ? SELECTED_COLOR : COLOR);
    }
    this.root.matrix.copy(world);
    this.root.updateMatrixWorld(true);
  }

  /** Returns the light that a ray hits, and its distance, m. */
  pick(ray: Raycaster): { name: string; distance: number } | null {
    const [hit] = ray.intersectObjects([...this.marks.values()], false);
    return hit ? { name: hit.object.name, distance: hit.distance } : null;
  }

  private createMark(name: string): Mesh<OctahedronGeometry, MeshBasicMaterial> {
    const mark = new Mesh(this.shape, new MeshBasicMaterial({ color: COLOR }));
    mark.name = name;
    mark.matrixAutoUpdate = false;
    this.marks.set(name, mark);
    this.root.add(mark);
    return mark;
  }
}
