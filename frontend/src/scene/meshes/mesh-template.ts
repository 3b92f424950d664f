import {
  Mesh,
  MeshStandardMaterial,
  NoColorSpace,
  type BufferGeometry,
  type Material,
  type MeshPhongMaterial,
  type Object3D,
  type Texture,
} from "three";
import { strings } from "../../strings";
import { texturesOf, type Surface } from "../materials";
import { MeshError } from "./mesh-error";
import { collapseNonFinite, describeNonFinite, type NonFiniteCounts } from "./non-finite";

/** A material of a mesh file. */
export interface FileMaterial {
  color: readonly [number, number, number];
  opacity: number;
  map: Texture | null;
  vertexColors: boolean;
  /** Its reflective properties, if the file specifies them. */
  surface?: Surface | null;
}

/** One geometry of a mesh, in the mesh's frame; `materials` has one entry, or one for each group of the geometry. */
export interface MeshPart {
  geometry: BufferGeometry;
  materials: readonly (FileMaterial | null)[];
  /** The names of the part and of the nodes around it in the file. */
  names?: readonly string[];
}

/** A mesh file prepared for drawing, shared by all links that show it. */
export interface MeshTemplate {
  parts: readonly MeshPart[];
  /** What is missing although the mesh can be drawn, such as a texture. */
  problem: string | null;
}

/** The gray that Assimp, and therefore RViz, gives a mesh without a color. */
export const UNCOLORED_GRAY = 0.6;

/** The parts of a loaded mesh. */
export interface FlattenedMesh {
  parts: MeshPart[];
  /** The counts of non-finite vertices of each part. */
  nonFinite: NonFiniteCounts[];
}

/**
 * Flattens the scene of a loader, whose textures must be loaded. `isFromFile` distinguishes the file's materials
 * from those that the loader added.
 */
export function flatten(root: Object3D, isFromFile: (material: Material) => boolean): FlattenedMesh {
  root.updateMatrixWorld(true);
  const parts: MeshPart[] = [];
  const nonFinite: NonFiniteCounts[] = [];
  root.traverse((object) => {
    if (!(object instanceof Mesh)) return;
    const mesh = object as Mesh;
    const geometry = mesh.geometry.clone().applyMatrix4(mesh.matrixWorld);
    nonFinite.push(collapseNonFinite(geometry));
    if (!geometry.hasAttribute("normal")) geometry.computeVertexNormals();
    const materials = Array.isArray(mesh.material) ? mesh.material : [mesh.material];
    const fileMaterials = materials.map((material) => (isFromFile(material) ? readMaterial(material) : null));
    parts.push({ geometry, materials: fileMaterials, names: listNames(object) });
  });
  return { parts, nonFinite };
}

/**
 * Returns the template of a file; `problem` names the missing parts.
 *
 * @throws MeshError if nothing can be drawn.
 */
export function createTemplate(format: string, { parts, nonFinite }: FlattenedMesh, problem: string | null): MeshTemplate {
  if (nonFinite.every(({ totalTriangles }) => totalTriangles === 0)) throw new MeshError(strings.meshes.noFaces(format));
  const problems = [problem, describeNonFinite(nonFinite)].filter((text) => text !== null);
  return { parts, problem: problems.join("; ") || null };
}

function listNames(object: Object3D): string[] {
  const names: string[] = [];
  for (let ancestor: Object3D | null = object; ancestor; ancestor = ancestor.parent) if (ancestor.name !== "") names.push(ancestor.name);
  return names;
}

function readMaterial(material: Material): FileMaterial {
  const { color, map: texture } = material as Partial<MeshPhongMaterial>;
  // Omit a texture that is missing: the surface would not be drawn at all.
  const map = texture?.image ? texture : null;
  if (map) map.colorSpace = NoColorSpace;
  return {
    color: color ? [color.r, color.g, color.b] : [UNCOLORED_GRAY, UNCOLORED_GRAY, UNCOLORED_GRAY],
    opacity: material.opacity,
    map,
    vertexColors: material.vertexColors,
    surface: material instanceof MeshStandardMaterial ? readSurface(material) : null,
  };
}

function readSurface(material: MeshStandardMaterial): Surface {
  const { roughness, metalness, normalMap, roughnessMap, metalnessMap, emissiveMap, aoMap } = material;
  const { r, g, b } = material.emissive.clone().multiplyScalar(material.emissiveIntensity);
  const surface = { roughness, metalness, normalMap, roughnessMap, metalnessMap, emissive: [r, g, b], emissiveMap, aoMap } as const;
  for (const map of texturesOf(surface)) if (map) map.colorSpace = NoColorSpace;
  return surface;
}
