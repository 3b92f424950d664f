import {
  BufferAttribute,
  BufferGeometry,
  Color,
  DoubleSide,
  Mesh,
  ShaderMaterial,
  type Box3,
  type ColorRepresentation,
} from "three";
import { areTranslucent, setBlending } from "../materials";
import { createRibbons, splitIntoStrips } from "./ribbons";

const VERTEX_SHADER = /* glsl */ `
  attribute vec3 direction;
  attribute float side;
  #ifdef COLORED
    attribute vec4 rgba;
  #endif
  uniform float width;
  varying vec4 vColor;
  void main() {
    #ifdef COLORED
      vColor = rgba;
    #else
      vColor = vec4(1.0);
    #endif
    vec4 viewPosition = modelViewMatrix * vec4(position, 1.0);
    vec3 lineOfSight = isOrthographic ? vec3(0.0, 0.0, -1.0) : viewPosition.xyz;
    vec3 sideDirection = cross(mat3(modelViewMatrix) * direction, lineOfSight);
    viewPosition.xyz += normalize(sideDirection) * side * width;
    gl_Position = projectionMatrix * viewPosition;
  }
`;
const FRAGMENT_SHADER = /* glsl */ `
  uniform vec4 color;
  varying vec4 vColor;
  void main() { gl_FragColor = color * vColor; }
`;

/**
 * Lines with a width in meters that face the camera: RViz's billboard lines. They are unlit and need one draw call,
 * without GPU instancing, see `CopyBatch`.
 */
export class WideLines {
  readonly root: Mesh<BufferGeometry, ShaderMaterial>;
  private opacity = 1;

  constructor() {
    const uniforms = { width: { value: 0.01 }, color: { value: [1, 1, 1, 1] } };
    this.root = new Mesh(
      new BufferGeometry(),
      new ShaderMaterial({ vertexShader: VERTEX_SHADER, fragmentShader: FRAGMENT_SHADER, uniforms, side: DoubleSide }),
    );
    this.root.frustumCulled = false;
    this.root.visible = false;
  }

  /** Sets segments by x y z of both ends of each; `colors` has r g b a of both ends, 0 to 1. */
  setSegments(segments: Float32Array, colors: Float32Array | null = null): void {
    this.setStrips(splitIntoStrips(segments), colors && splitIntoStrips(colors, 4));
  }

  /**
   * Sets lines through the points of each strip; `colors` has r g b a of each point, 0 to 1, multiplied by the style's
   * color.
   */
  setStrips(strips: readonly Float32Array[], colors: readonly Float32Array[] | null = null): void {
    const ribbons = createRibbons(strips, colors);
    const geometry = new BufferGeometry().setIndex(new BufferAttribute(ribbons.indices, 1));
    geometry.setAttribute("position", new BufferAttribute(ribbons.positions, 3));
    geometry.setAttribute("direction", new BufferAttribute(ribbons.directions, 3));
    geometry.setAttribute("side", new BufferAttribute(ribbons.sides, 1));
    if (ribbons.colors) geometry.setAttribute("rgba", new BufferAttribute(ribbons.colors, 4));
    this.root.geometry.dispose();
    this.root.geometry = geometry;
    this.root.visible = ribbons.indices.length > 0;
    this.updateMaterial();
  }

  /** Sets the style; `width` in m. */
  setStyle(color: ColorRepresentation, opacity: number, width: number): void {
    const { r, g, b } = new Color(color);
    const { uniforms } = this.root.material;
    uniforms["color"] = { value: [r, g, b, opacity] };
    uniforms["width"] = { value: width };
    this.opacity = opacity;
    this.updateMaterial();
  }

  /** Expands `box` by the center lines, in the world frame. */
  expandBox(box: Box3): void {
    if (this.root.visible) box.expandByObject(this.root);
  }

  dispose(): void {
    this.root.removeFromParent();
    this.root.geometry.dispose();
    this.root.material.dispose();
  }

  private updateMaterial(): void {
    const { material, geometry } = this.root;
    const colors = geometry.attributes["rgba"];
    material.defines = colors ? { COLORED: "" } : {};
    setBlending(material, areTranslucent(this.opacity, colors));
  }
}
