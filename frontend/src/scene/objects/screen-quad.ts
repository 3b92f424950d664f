import { Mesh, OrthographicCamera, PlaneGeometry, Scene, type ShaderMaterial, type WebGLRenderer } from "three";

/** The vertex shader of materials that cover the whole image; it provides `vUv`. */
export const SCREEN_VERTEX = /* glsl */ `
  varying vec2 vUv;
  void main() { vUv = uv; gl_Position = vec4(position.xy, 0.0, 1.0); }
`;

/** Draws a material over the whole image. */
export class ScreenQuad {
  private readonly scene = new Scene();
  private readonly camera = new OrthographicCamera();

  private readonly quad: Mesh<PlaneGeometry, ShaderMaterial>;

  constructor(material: ShaderMaterial) {
    this.quad = new Mesh(new PlaneGeometry(2, 2), material);
    this.quad.frustumCulled = false;
    this.scene.add(this.quad);
  }

  /** Draws the material over the existing image. */
  render(renderer: WebGLRenderer): void {
    renderer.autoClear = false;
    renderer.render(this.scene, this.camera);
    renderer.autoClear = true;
  }

  dispose(): void {
    this.quad.geometry.dispose();
    this.quad.material.dispose();
  }
}
