import {
  BufferAttribute,
  BufferGeometry,
  DoubleSide,
  Group,
  Mesh,
  MeshBasicMaterial,
  MeshLambertMaterial,
  type Material,
  type Object3D,
  type Sprite,
} from "three";
import type { MarkerMesh, MarkerShape } from "../../protocol";
import { loadTexture, MIN_OPAQUE_ALPHA } from "../materials";
import type { MeshLibrary } from "../meshes/mesh-library";
import type { FileMaterial } from "../meshes/mesh-template";
import { PointBatch } from "../objects/point-batch";
import { WideLines } from "../objects/wide-lines";
import { createTextSprite } from "./text-sprite";

/** A marker with a three.js object of its own: lines, points, text, triangles or a mesh. */
export interface MarkerObject {
  readonly root: Object3D;
  /** Whether its mesh and texture are loaded. */
  readonly isSettled: boolean;
  dispose(): void;
}

/**
 * Creates the object of a marker; `onChanged` is called when a mesh or texture has arrived, with the problem or null.
 */
export function createMarkerObject(
  marker: MarkerShape,
  meshes: MeshLibrary,
  onChanged: (problem: string | null) => void,
): MarkerObject {
  const { shape } = marker;
  if (shape === "line_strip" || shape === "line_list") return new LinesMarker(marker);
  if (shape === "points") return new PointsMarker(marker);
  if (shape === "text") return new TextMarker(marker);
  if (shape === "triangle_list") return new TrianglesMarker(marker, onChanged);
  return new MeshMarker(marker, meshes, onChanged);
}

class LinesMarker implements MarkerObject {
  readonly root = new Group();
  readonly isSettled = true;
  private readonly lines = new WideLines();

  constructor({ shape, points, colors, color, scale }: MarkerShape) {
    const hasOwnColors = colors.length > 0 && colors.length / 4 === points.length / 3;
    if (shape === "line_strip") this.lines.setStrips([points], hasOwnColors ? [colors] : null);
    else this.lines.setSegments(points, hasOwnColors ? colors : null);
    const [r = 1, g = 1, b = 1, a = 1] = color;
    this.lines.setStyle(hasOwnColors ? 0xffffff : packRgb(r, g, b), hasOwnColors ? 1 : a, scale[0] ?? 0);
    this.root.add(this.lines.root);
  }

  dispose(): void {
    this.lines.dispose();
  }
}

class TextMarker implements MarkerObject {
  readonly isSettled = true;
  readonly root: Sprite;

  constructor({ text, scale, color }: MarkerShape) {
    this.root = createTextSprite(text, scale[2] ?? 1, color);
  }

  dispose(): void {
    this.root.material.map?.dispose();
    this.root.material.dispose();
  }
}

class TrianglesMarker implements MarkerObject {
  readonly root: Mesh<BufferGeometry, MeshBasicMaterial | MeshLambertMaterial>;
  isSettled = true;

  constructor(marker: MarkerShape, onChanged: (problem: string | null) => void) {
    const { points, scale, color, texture, uvs } = marker;
    const geometry = new BufferGeometry().setAttribute("position", new BufferAttribute(points, 3));
    geometry.computeVertexNormals();
    const colors = createVertexColors(marker);
    const alpha = color[3] ?? 1;
    let isTranslucent = alpha < MIN_OPAQUE_ALPHA;
    if (colors) {
      geometry.setAttribute("color", new BufferAttribute(colors, 4));
      for (let i = 3; i < colors.length; i += 4) isTranslucent ||= (colors[i] ?? 1) < MIN_OPAQUE_ALPHA;
    }
    const style = { side: DoubleSide, transparent: isTranslucent, depthWrite: !isTranslucent, vertexColors: colors !== null };
    // As in RViz, triangles with individual colors are not lit.
    const material = colors ? new MeshBasicMaterial(style) : new MeshLambertMaterial({ ...style, opacity: alpha });
    if (!colors && texture === null) material.color.setRGB(color[0] ?? 0, color[1] ?? 0, color[2] ?? 0);
    this.root = new Mesh(geometry, material);
    this.root.scale.set(scale[0] ?? 1, scale[1] ?? 1, scale[2] ?? 1);
    if (texture !== null) {
      geometry.setAttribute("uv", new BufferAttribute(uvs, 2));
      this.isSettled = false;
      void this.loadTexture(texture, onChanged);
    }
  }

  dispose(): void {
    this.root.geometry.dispose();
    this.root.material.map?.dispose();
    this.root.material.dispose();
  }

  private async loadTexture(texture: string, onChanged: (problem: string | null) => void): Promise<void> {
    let problem: string | null = null;
    try {
      this.root.material.map = await loadTexture(texture);
      this.root.material.needsUpdate = true;
    } catch {
      problem = `could not load texture '${decodeURIComponent(texture.split("/").pop() ?? texture)}'`;
    }
    this.isSettled = true;
    onChanged(problem);
  }
}

class PointsMarker implements MarkerObject {
  readonly isSettled = true;
  private readonly batch: PointBatch;

  constructor({ points, colors, color, scale }: MarkerShape) {
    const hasOwnColors = colors.length > 0 && colors.length / 4 === points.length / 3;
    const [r = 1, g = 1, b = 1, a = 1] = color;
    const [width = 0.01, height = 0.01] = scale;
    this.batch = new PointBatch({
      style: "Squares",
      size: [width, height, 0],
      pixels: 1,
      perDepth: 0,
      color: `#${packRgb(r, g, b).toString(16).padStart(6, "0")}`,
      alpha: hasOwnColors ? 1 : a,
    });
    const bytes = Uint8Array.from(hasOwnColors ? colors : [], (value) => Math.round(255 * Math.max(0, Math.min(1, value))));
    this.batch.setPoints(points, bytes, bytes.some((value, i) => i % 4 === 3 && value < 255));
  }

  get root(): Object3D {
    return this.batch.root;
  }

  dispose(): void {
    this.batch.dispose();
  }
}

class MeshMarker implements MarkerObject {
  readonly root = new Group();
  isSettled = false;
  private materials: Material[] = [];
  private isDisposed = false;

  constructor(
    private readonly marker: MarkerShape,
    library: MeshLibrary,
    onChanged: (problem: string | null) => void,
  ) {
    const [x = 1, y = 1, z = 1] = marker.scale;
    this.root.scale.set(x, y, z);
    if (marker.mesh) void this.load(marker.mesh, library, onChanged);
  }

  dispose(): void {
    this.isDisposed = true;
    for (const material of this.materials) material.dispose();
  }

  private async load(mesh: MarkerMesh, library: MeshLibrary, onChanged: (problem: string | null) => void): Promise<void> {
    const blob = mesh.data ? new Blob([new Uint8Array(mesh.data)]) : null;
    const url = blob ? URL.createObjectURL(blob) : (mesh.url ?? "");
    let problem: string | null = null;
    try {
      const template = await library.load(url, mesh.format);
      problem = template.problem;
      if (!this.isDisposed) {
        for (const { geometry, materials } of template.parts) {
          const paintedMaterials = materials.map((material) => this.createMaterial(mesh.embedded ? material : null));
          this.materials.push(...paintedMaterials);
          const [material] = paintedMaterials;
          this.root.add(new Mesh(geometry, paintedMaterials.length === 1 && material ? material : paintedMaterials));
        }
      }
    } catch (error) {
      problem = error instanceof Error ? error.message : String(error);
    }
    if (blob) URL.revokeObjectURL(url);
    this.isSettled = true;
    if (!this.isDisposed) onChanged(problem);
  }

  /**
   * Returns a material by RViz's rule: the marker's color tints the mesh's own materials, and is ignored for them if
   * it is all zero.
   */
  private createMaterial(embeddedMaterial: FileMaterial | null): Material {
    let [r = 0, g = 0, b = 0, a = 0] = this.marker.color;
    if (this.marker.mesh?.embedded === true && r === 0 && g === 0 && b === 0 && a === 0) r = g = b = a = 1;
    const [ownR, ownG, ownB] = embeddedMaterial?.color ?? [1, 1, 1];
    const alpha = a * (embeddedMaterial?.opacity ?? 1);
    const material = new MeshLambertMaterial({
      opacity: alpha,
      transparent: alpha < MIN_OPAQUE_ALPHA,
      depthWrite: alpha >= MIN_OPAQUE_ALPHA,
      map: embeddedMaterial?.map ?? null,
      vertexColors: embeddedMaterial?.vertexColors ?? false,
      side: DoubleSide,
    });
    material.color.setRGB(r * ownR, g * ownG, b * ownB);
    return material;
  }
}

/** Returns red, green, blue and alpha of each vertex, if the marker has a color for each vertex or each triangle. */
function createVertexColors({ points, colors, color }: MarkerShape): Float32Array | null {
  const vertexCount = points.length / 3;
  const colorCount = colors.length / 4;
  if (colorCount === 0 || (colorCount !== vertexCount && colorCount !== vertexCount / 3)) return null;
  const verticesPerColor = vertexCount / colorCount;
  const alpha = color[3] ?? 1;
  const vertexColors = new Float32Array(vertexCount * 4);
  for (let i = 0; i < vertexCount; i++) {
    const offset = Math.floor(i / verticesPerColor) * 4;
    vertexColors.set(colors.subarray(offset, offset + 4), i * 4);
    vertexColors[i * 4 + 3] = alpha * (colors[offset + 3] ?? 1);
  }
  return vertexColors;
}

function packRgb(r: number, g: number, b: number): number {
  const toByte = (value: number): number => Math.max(0, Math.min(255, Math.round(value * 255)));
  return (toByte(r) << 16) | (toByte(g) << 8) | toByte(b);
}
