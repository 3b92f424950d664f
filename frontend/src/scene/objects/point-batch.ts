import {
  BufferAttribute,
  BufferGeometry,
  Group,
  Mesh,
  Points,
  Sphere,
  Vector4,
  type ShaderMaterial,
  type WebGLRenderer,
} from "three";
import { MIN_OPAQUE_ALPHA } from "../materials";
import { createPointMaterial, setLook, type PointLook, type PointVariant } from "./point-material";

/**
 * Up to this number, points are drawn as quads, which may be larger than the screen but are slow on software renderers.
 */
const MAX_QUAD_POINTS = 20_000;
const CORNERS = [-1, -1, 1, -1, 1, 1, -1, 1] as const;

/** Many points with one look in one draw call. */
export class PointBatch {
  readonly root = new Group();
  positions: Float32Array = new Float32Array(0);
  /** Red, green, blue and alpha of each point; empty if all have the color of the look. */
  colors: Uint8Array = new Uint8Array(0);
  private object: Points<BufferGeometry, ShaderMaterial> | Mesh<BufferGeometry, ShaderMaterial> | null = null;
  private variantKey = "";
  private hasTranslucentColors = false;

  constructor(private look: PointLook) {}

  get count(): number {
    return this.positions.length / 3;
  }

  /** Sets the points, x y z of each in m; `hasTranslucentColors` if some have less than full alpha. */
  setPoints(positions: Float32Array, colors: Uint8Array, hasTranslucentColors: boolean): void {
    this.positions = positions;
    this.colors = colors;
    this.hasTranslucentColors = hasTranslucentColors;
    this.build();
  }

  setLook(look: PointLook): void {
    const needsNewMesh = this.variantKey !== JSON.stringify(this.variantFor(look));
    this.look = look;
    if (needsNewMesh) this.build();
    else if (this.object) setLook(this.object.material, look);
  }

  dispose(): void {
    this.root.removeFromParent();
    this.clear();
  }

  private variantFor(look: PointLook): PointVariant {
    return {
      style: look.style,
      isTinted: this.colors.length > 0,
      hasQuads: look.style !== "Points" && this.count <= MAX_QUAD_POINTS,
      isTranslucent: look.alpha < MIN_OPAQUE_ALPHA || this.hasTranslucentColors,
    };
  }

  private build(): void {
    const variant = this.variantFor(this.look);
    const geometry = variant.hasQuads ? createQuads(this.positions, this.colors) : createPoints(this.positions, this.colors);
    // three.js would look at every point to sort by distance.
    geometry.boundingSphere = new Sphere();
    const key = JSON.stringify(variant);
    if (this.object && key === this.variantKey) {
      this.object.geometry.dispose();
      this.object.geometry = geometry;
      setLook(this.object.material, this.look);
      return;
    }
    this.clear();
    this.variantKey = key;
    const material = createPointMaterial(variant);
    setLook(material, this.look);
    this.object = variant.hasQuads ? new Mesh(geometry, material) : new Points(geometry, material);
    // Computing their bounds costs more than drawing the points outside the view.
    this.object.frustumCulled = false;
    this.object.onBeforeRender = (renderer) => setViewport(renderer, material);
    this.root.add(this.object);
  }

  private clear(): void {
    if (!this.object) return;
    this.object.removeFromParent();
    this.object.geometry.dispose();
    this.object.material.dispose();
    this.object = null;
  }
}

const viewport = new Vector4();

/** Sets the size of the render target in pixels, which the shader needs: the canvas, or a camera's image. */
function setViewport(renderer: WebGLRenderer, material: ShaderMaterial): void {
  renderer.getCurrentViewport(viewport);
  const uniform = material.uniforms["viewport"];
  if (uniform) uniform.value = [viewport.z, viewport.w];
  material.uniformsNeedUpdate = true;
}

function createPoints(positions: Float32Array, colors: Uint8Array): BufferGeometry {
  const geometry = new BufferGeometry().setAttribute("position", new BufferAttribute(positions, 3));
  if (colors.length > 0) geometry.setAttribute("tint", new BufferAttribute(colors, 4, true));
  return geometry;
}

/** Returns four corners for each point. */
function createQuads(positions: Float32Array, colors: Uint8Array): BufferGeometry {
  const count = positions.length / 3;
  const [cornerPositions, corners] = [new Float32Array(count * 12), new Float32Array(count * 8)];
  const indices = new Uint32Array(count * 6);
  for (let i = 0; i < count; i++) {
    const position = positions.subarray(i * 3, i * 3 + 3);
    for (let corner = 0; corner < 4; corner++) cornerPositions.set(position, i * 12 + corner * 3);
    corners.set(CORNERS, i * 8);
    const firstVertex = i * 4;
    indices.set([firstVertex, firstVertex + 1, firstVertex + 2, firstVertex, firstVertex + 2, firstVertex + 3], i * 6);
  }
  const geometry = new BufferGeometry().setIndex(new BufferAttribute(indices, 1));
  geometry.setAttribute("position", new BufferAttribute(cornerPositions, 3));
  geometry.setAttribute("corner", new BufferAttribute(corners, 2));
  if (colors.length > 0) {
    const tints = new Uint8Array(count * 16);
    for (let i = 0; i < count; i++) {
      const tint = colors.subarray(i * 4, i * 4 + 4);
      for (let corner = 0; corner < 4; corner++) tints.set(tint, i * 16 + corner * 4);
    }
    geometry.setAttribute("tint", new BufferAttribute(tints, 4, true));
  }
  return geometry;
}
