import {
  Color,
  DoubleSide,
  MeshBasicMaterial,
  ShaderMaterial,
  Vector2,
  WebGLRenderTarget,
  type Object3D,
} from "three";
import { SCREEN_VERTEX, ScreenQuad } from "./objects/screen-quad";
import type { Viewport } from "./viewport";

const OUTLINE_LAYER = 1;
const COLOR = 0x5db0ff;
const FRAGMENT = /* glsl */ `
  uniform sampler2D mask;
  uniform vec2 texel;
  uniform vec3 color;
  varying vec2 vUv;
  void main() {
    float inside = texture2D(mask, vUv).r;
    float near = 0.0;
    for (int x = -1; x <= 1; x++)
      for (int y = -1; y <= 1; y++)
        near = max(near, texture2D(mask, vUv + vec2(x, y) * texel).r);
    gl_FragColor = vec4(color, max((near - inside) * 0.95, inside * 0.16));
  }
`;
/** Draws a line around the selected objects, also where something hides them, and a tint over them. */
export class Outline {
  private objects: readonly Object3D[] = [];
  private readonly mask = new WebGLRenderTarget(1, 1, { samples: 4 });
  private readonly white = new MeshBasicMaterial({ color: 0xffffff, side: DoubleSide });
  private readonly uniforms = {
    mask: { value: this.mask.texture },
    texel: { value: new Vector2() },
    color: { value: new Color(COLOR) },
  };

  private readonly quad = new ScreenQuad(
    new ShaderMaterial({
      vertexShader: SCREEN_VERTEX,
      fragmentShader: FRAGMENT,
      uniforms: this.uniforms,
      transparent: true,
      depthTest: false,
      depthWrite: false,
    }),
  );

  constructor(private readonly viewport: Viewport) {}

  set(objects: readonly Object3D[]): void {
    for (const object of this.objects) object.layers.disable(OUTLINE_LAYER);
    for (const object of objects) object.layers.enable(OUTLINE_LAYER);
    this.objects = objects;
  }

  /** Draws over the frame that was just rendered. */
  render(): void {
    if (this.objects.length === 0) return;
    const { renderer, scene, camera } = this.viewport;
    const size = renderer.getDrawingBufferSize(new Vector2());
    const background = renderer.getClearColor(new Color());
    this.mask.setSize(size.x, size.y);
    const width = renderer.getPixelRatio() * 1.5;
    this.uniforms.texel.value.set(width / size.x, width / size.y);
    renderer.setClearColor(0x000000);
    renderer.setRenderTarget(this.mask);
    scene.overrideMaterial = this.white;
    camera.layers.set(OUTLINE_LAYER);
    renderer.render(scene, camera);
    camera.layers.set(0);
    scene.overrideMaterial = null;
    renderer.setRenderTarget(null);
    renderer.setClearColor(background);
    this.quad.render(renderer);
  }
}
