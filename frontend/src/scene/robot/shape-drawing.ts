import { Box3, Color, DoubleSide, Group, Matrix4, Mesh, MeshLambertMaterial, type BufferGeometry, type Material, type Texture } from "three";
import type { Shape } from "../../protocol";
import type { LinkOverride } from "../../state/comparison";
import { strings } from "../../strings";
import { PICKABLE_LAYER } from "../layers";
import { errorMaterial, MIN_OPAQUE_ALPHA, RVIZ_RED, type Look, type MaterialPool, type Surface } from "../materials";
import { quoteNames } from "../meshes/mesh-error";
import type { MeshLibrary } from "../meshes/mesh-library";
import type { LodMesh } from "../meshes/lod-mesh";
import type { LodMeshes } from "../meshes/lod-meshes";
import { UNCOLORED_GRAY, type MeshTemplate, type FileMaterial } from "../meshes/mesh-template";
import { extrudePolygons, createHeightmap, selectSubmesh } from "../objects/world-geometries";
import { setPoseMatrix } from "../pose";
import { createCapsule, unitBox, unitCone, unitCylinder, unitPlane, unitSphere } from "../objects/geometries";
import { solidKindOf, type SolidKind } from "./solids";

/** The tolerance for equal poses: m, and elements of rotation matrices. */
const POSE_TOLERANCE = 1e-6;

/** A part of a shape: its mesh, and the materials from the file. */
interface ShapePart {
  mesh: Mesh;
  fileMaterials: readonly (FileMaterial | null)[];
}

/** A shape that is drawn in a batch instead of as a mesh of its own. */
export interface Solid {
  readonly kind: SolidKind;
  /** The matrix from the unit shape to the link. */
  readonly matrix: Matrix4;
  /** The color, 0xrrggbb. */
  readonly color: number;
}

/** A piece of a shape that may be drawn together with others while the robot moves. */
export interface ShapePiece {
  readonly lodMesh: LodMesh;
  /** The matrix from the mesh to the link. */
  readonly matrix: Matrix4;
  /** The color, 0xrrggbb. */
  readonly color: number;
}

/** The result of `ShapeDrawing.inspect`. */
export interface InspectedShape {
  kind: string;
  bounds: { min: number[]; max: number[] } | null;
  materials: { color: string; opacity: number; textured: boolean; reflects?: true }[];
}

/** The drawing of one visual or collision of a link. */
export class ShapeDrawing {
  readonly root = new Group();
  private parts: ShapePart[] = [];
  private texture: Texture | null = null;
  private surface: Surface | null = null;
  private library: MeshLibrary | null = null;
  /** The addresses of the library's textures that this shape uses. */
  private readonly usedTextureUrls: string[] = [];
  /** A geometry of its own, which it must dispose of. */
  private ownGeometry: BufferGeometry | null = null;
  private problem: string | null = null;
  private solidInBatch: Solid | null = null;

  constructor(readonly shape: Shape) {
    const [x = 0, y = 0, z = 0] = shape.position;
    const [qx = 0, qy = 0, qz = 0, qw = 1] = shape.quaternion;
    this.root.position.set(x, y, z);
    this.root.quaternion.set(qx, qy, qz, qw);
    this.buildPrimitive();
    this.root.updateMatrix();
    this.root.matrixAutoUpdate = false;
  }

  /** Whether the shape is drawn; false for a mesh that is not loaded. */
  get isDrawn(): boolean {
    return this.parts.length > 0;
  }

  /** Its entry in a batch, if any; its mesh then serves rays and outlines only. */
  get solid(): Solid | null {
    return this.solidInBatch;
  }

  get meshes(): readonly Mesh[] {
    return this.parts.map((part) => part.mesh);
  }

  /**
   * Loads the shape's mesh and textures.
   *
   * @returns what is missing although the shape is drawn, or null.
   * @throws Error if the mesh cannot be drawn.
   */
  async load(library: MeshLibrary): Promise<string | null> {
    const { kind, url, format, texture, surface } = this.shape;
    if (kind === "mesh" && url !== null) this.buildMesh(await library.load(url, format ?? ""));
    this.library = library;
    const problems = this.problem === null ? [] : [this.problem];
    const loadTextureAt = async (address: string | null): Promise<Texture | null> => {
      if (address === null || this.library === null) return null;
      const url = library.files.addressOf(address);
      this.usedTextureUrls.push(url);
      try {
        return await library.textures.acquire(url);
      } catch {
        problems.push(strings.meshes.missingTextures(quoteNames([decodeURIComponent(address.split("/").pop() ?? address)])));
        return null;
      }
    };
    this.texture = await loadTextureAt(texture);
    if (surface) {
      const { roughness, metalness, normal_map, roughness_map, metalness_map, emissive_map, occlusion_map } = surface;
      const maps = [normal_map, roughness_map, metalness_map, emissive_map, occlusion_map] as const;
      const [normalMap = null, roughnessMap = null, metalnessMap = null, emissiveMap = null, aoMap = null] = await Promise.all(maps.map(loadTextureAt));
      const emissive = emissiveMap ? ([1, 1, 1] as const) : ([0, 0, 0] as const);
      this.surface = { roughness, metalness, normalMap, roughnessMap, metalnessMap, emissive, emissiveMap, aoMap };
    }
    return problems.length > 0 ? problems.join("; ") : null;
  }

  /**
   * Applies materials; `alpha` includes that of the robot and the link, and `isLost` means RViz's white of links
   * without a transform.
   *
   * @param override - replaces all colors and textures.
   */
  paint(pool: MaterialPool, alpha: number, isLost: boolean, override: LinkOverride | null = null): void {
    for (const { mesh, fileMaterials } of this.parts) {
      const materials = fileMaterials.map((material) => (isLost ? errorMaterial : pool.get(this.createLook(material, alpha, override))));
      const [material = errorMaterial] = materials;
      mesh.material = materials.length === 1 ? material : materials;
    }
    this.solidInBatch = isLost || pool.isLit ? null : this.createSolid(override, alpha);
    for (const { mesh } of this.parts) {
      if (this.solidInBatch) {
        mesh.layers.disable(0);
        mesh.layers.enable(PICKABLE_LAYER);
      } else mesh.layers.enable(0);
    }
  }

  /**
   * Adds the meshes that have LOD meshes, and the pieces of these LOD meshes.
   *
   * @returns whether all requested LOD meshes are available.
   */
  addPieces(lodMeshes: LodMeshes, meshes: Mesh[], pieces: ShapePiece[]): boolean {
    let isComplete = true;
    if (this.shape.kind !== "mesh") return isComplete;
    for (const { mesh } of this.parts) {
      const materials = [mesh.material].flat();
      if (!materials.every(isPlain)) continue;
      const groupMeshes = lodMeshes.getOrRequest(mesh.geometry);
      isComplete &&= groupMeshes !== null;
      if (!groupMeshes || groupMeshes.length === 0) continue;
      const matrix = new Matrix4().multiplyMatrices(this.root.matrix, mesh.matrix);
      const { groups } = mesh.geometry;
      groupMeshes.forEach((lodMesh, i) => {
        const material = materials[groups[i]?.materialIndex ?? 0] ?? materials[0];
        if (material) pieces.push({ lodMesh, matrix, color: material.color.getHex() });
      });
      meshes.push(mesh);
    }
    return isComplete;
  }

  /** Whether the description places the shape at a pose in its link. */
  isAt(pose: Matrix4): boolean {
    const [x = 0, y = 0, z = 0] = this.shape.position;
    const shapePose = setPoseMatrix([x, y, z, ...this.shape.quaternion], new Matrix4());
    return shapePose.elements.every((value, i) => Math.abs(value - (pose.elements[i] ?? NaN)) < POSE_TOLERANCE);
  }

  /** Draws the shape at another pose in its link; null restores that of the description. */
  displace(pose: Matrix4 | null): void {
    if (pose) this.root.matrix.copy(pose);
    else this.root.updateMatrix();
    this.root.matrixWorldNeedsUpdate = true;
    const [part] = this.parts;
    if (!this.solidInBatch || !part) return;
    this.solidInBatch = { ...this.solidInBatch, matrix: new Matrix4().multiplyMatrices(this.root.matrix, part.mesh.matrix) };
  }

  /** Returns what is drawn, for tests: bounds in the fixed frame, and color, opacity and texture of each material. */
  inspect(): InspectedShape {
    const box = new Box3();
    for (const { mesh } of this.parts) {
      mesh.updateWorldMatrix(true, false);
      box.expandByObject(mesh, true);
    }
    const materials = this.parts.flatMap(({ mesh }) => mesh.material) as unknown as MeshLambertMaterial[];
    return {
      kind: this.shape.kind,
      bounds: box.isEmpty() ? null : { min: box.min.toArray(), max: box.max.toArray() },
      materials: materials.map((material) => ({
        color: `#${material.color.getHexString()}`,
        opacity: material.opacity,
        textured: material.map !== null,
        ...("roughness" in material ? { reflects: true as const } : {}),
      })),
    };
  }

  dispose(): void {
    for (const url of this.usedTextureUrls) this.library?.textures.release(url);
    this.library = null;
    this.ownGeometry?.dispose();
  }

  private buildPrimitive(): void {
    const [a = 1, b = 1, c = 1] = this.shape.size;
    switch (this.shape.kind) {
      case "box":
        this.addPart(unitBox, [null]).scale.set(a, b, c);
        break;
      case "cylinder":
        this.addPart(unitCylinder, [null]).scale.set(a, a, b);
        break;
      case "capsule":
        this.addPart(createCapsule(a > 0 ? b / a : 0), [null]).scale.setScalar(a);
        break;
      case "sphere":
        this.addPart(unitSphere, [null]).scale.setScalar(a);
        break;
      case "ellipsoid":
        this.addPart(unitSphere, [null]).scale.set(a, b, c);
        break;
      case "cone":
        this.addPart(unitCone, [null]).scale.set(a, a, b);
        break;
      case "plane":
        this.addPart(unitPlane, [null]).scale.set(a, b, 1);
        break;
      case "polyline":
        this.buildPart(extrudePolygons(this.shape.outlines, a));
        break;
      case "heightmap":
        if (this.shape.heights) this.buildPart(createHeightmap(this.shape.heights, this.shape.columns, this.shape.size));
        break;
      case "mesh":
        break;
    }
    this.updateMatrices();
  }

  /** Builds a part with a geometry that no other shape shares. */
  private buildPart(geometry: BufferGeometry): void {
    this.addPart(geometry, [null]);
    this.ownGeometry = geometry;
    this.updateMatrices();
  }

  private buildMesh(template: MeshTemplate): void {
    const [x = 1, y = 1, z = 1] = this.shape.size;
    const { parts, offset } = selectSubmesh(template.parts, this.shape.submesh);
    for (const part of parts) {
      const mesh = this.addPart(part.geometry, part.materials);
      mesh.scale.set(x, y, z);
      mesh.position.copy(offset).multiply(mesh.scale);
    }
    this.problem = template.problem;
    this.updateMatrices();
  }

  private addPart(geometry: BufferGeometry, fileMaterials: readonly (FileMaterial | null)[]): Mesh {
    const mesh = new Mesh<BufferGeometry, Material | Material[]>(geometry, errorMaterial);
    this.parts.push({ mesh, fileMaterials });
    this.root.add(mesh);
    return mesh;
  }

  private createSolid(override: LinkOverride | null, alpha: number): Solid | null {
    const kind = solidKindOf(this.shape.kind);
    const [part] = this.parts;
    const look = this.createLook(null, alpha, override);
    if (kind === null || !part || look.map || look.alpha < MIN_OPAQUE_ALPHA) return null;
    return {
      kind,
      matrix: new Matrix4().multiplyMatrices(this.root.matrix, part.mesh.matrix),
      color: new Color(...look.color).getHex(),
    };
  }

  private updateMatrices(): void {
    for (const { mesh } of this.parts) {
      mesh.updateMatrix();
      mesh.matrixAutoUpdate = false;
    }
  }

  /**
   * Returns a look by RViz's rule: a part with a material of its own keeps it, and any other takes the URDF's. Without
   * one, a primitive or STL is RViz's red, and another mesh the gray that RViz's mesh reader sets. Only the URDF sets
   * the opacity of a part: RViz does not read it from mesh files, where exporters often write it wrongly.
   */
  private createLook(fileMaterial: FileMaterial | null, alpha: number, override: LinkOverride | null): Look {
    if (override) return { color: override.color, map: null, hasVertexColors: false, alpha, isDoubleSided: true, isBehind: override.isBehind === true };
    const { kind, repaints } = this.shape;
    const isDoubleSided = kind === "mesh";
    const isBehind = kind === "plane";
    if (fileMaterial && !repaints) {
      const { color, map, vertexColors: hasVertexColors, surface } = fileMaterial;
      return { color, map, hasVertexColors, surface: surface ?? null, alpha: alpha * (this.shape.color?.[3] ?? 1), isDoubleSided };
    }
    const isGray = isDoubleSided && !this.shape.format?.startsWith("stl");
    const defaultColor: readonly number[] = isGray ? [UNCOLORED_GRAY, UNCOLORED_GRAY, UNCOLORED_GRAY] : RVIZ_RED;
    // A texture replaces the color.
    const [r = 0, g = 0, b = 0, a = 1] = this.texture ? [1, 1, 1, 1] : (this.shape.color ?? defaultColor);
    return { color: [r, g, b], map: this.texture, hasVertexColors: false, alpha: alpha * a, isDoubleSided, isBehind, surface: this.surface };
  }
}

/** Whether a surface has a plain opaque color and the camera's light only. */
function isPlain(material: Material): material is MeshLambertMaterial {
  if (!(material instanceof MeshLambertMaterial) || material.side !== DoubleSide) return false;
  return material.map === null && !material.vertexColors && !material.transparent;
}
