import { Group, Matrix4, Mesh, MeshBasicMaterial, OctahedronGeometry, type Raycaster } from "three";
import type { Modelling } from "../../state/modelling/modelling";
import { entityMatrix } from "./entity-pose";

/** m. */
const RADIUS = 0.12;
const [COLOR, SELECTED] = [0xffd54a, 0x5db0ff];

/** Marks at the lights of the world, which could not be seen or clicked otherwise. */
export class LightMarks {
  /** In the world's frame. */
  readonly root = new Group();
  private readonly shape = new OctahedronGeometry(RADIUS);
  private readonly marks = new Map<string, Mesh<OctahedronGeometry, MeshBasicMaterial>>();

  constructor(private readonly modelling: Modelling) {
    this.root.matrixAutoUpdate = false;
  }

  /** Matches the lights there are; `moved` are those shown elsewhere. */
  update(world: Matrix4, moved: ReadonlyMap<string, Matrix4>): void {
    const { active, entities, selected } = this.modelling;
    const lights = active ? entities.filter(({ kind }) => kind === "light") : [];
    for (const [name, mark] of this.marks) {
      if (lights.some((light) => light.name === name)) continue;
      mark.removeFromParent();
      mark.material.dispose();
      this.marks.delete(name);
    }
    for (const { name, pose } of lights) {
      const mark = this.marks.get(name) ?? this.make(name);
      mark.matrix.copy(entityMatrix(pose));
      mark.matrix.premultiply(moved.get(name) ?? new Matrix4());
      mark.material.color.setHex(selected.includes(name) ? SELECTED : COLOR);
    }
    this.root.matrix.copy(world);
    this.root.updateMatrixWorld(true);
  }

  /** The light that a ray meets, and how far away, m. */
  pick(ray: Raycaster): { name: string; distance: number } | null {
    const [hit] = ray.intersectObjects([...this.marks.values()], false);
    return hit ? { name: hit.object.name, distance: hit.distance } : null;
  }

  private make(name: string): Mesh<OctahedronGeometry, MeshBasicMaterial> {
    const mark = new Mesh(this.shape, new MeshBasicMaterial({ color: COLOR }));
    mark.name = name;
    mark.matrixAutoUpdate = false;
    this.marks.set(name, mark);
    this.root.add(mark);
    return mark;
  }
}
