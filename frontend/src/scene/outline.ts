import {
  Color,
  DoubleSide,
  MeshBasicMaterial,
  ShaderMaterial,
  Vector2,
  WebGLRenderTarget,
  type Object3D,
} from "three";
import { SELECTED_LAYER } from "./layers";
import { SCREEN_VERTEX, ScreenQuad } from "./objects/screen-quad";
import type { Viewport } from "./viewport";

/** How an outline is drawn. Each needs its own layer; `fill` is the strength of the tint over the objects, 0 to 1. */
interface OutlineLook {
  color: number;
  layer: number;
  fill: number;
}

/** The width of the line, CSS pixels. */
const LINE_WIDTH_PX = 1.5;
const SELECTION_LOOK: OutlineLook = { color: 0x5db0ff, layer: SELECTED_LAYER, fill: 0.16 };
const FRAGMENT_SHADER = /* glsl */ `
  uniform sampler2D mask;
  uniform vec2 texel;
  uniform vec3 color;
  uniform float fill;
  uniform float strength;
  varying vec2 vUv;
  void main() {
    float inside = texture2D(mask, vUv).r;
    float dilated = 0.0;
    for (int x = -1; x <= 1; x++)
      for (int y = -1; y <= 1; y++)
        dilated = max(dilated, texture2D(mask, vUv + vec2(x, y) * texel).r);
    gl_FragColor = vec4(color, max((dilated - inside) * 0.95, inside * fill) * strength);
  }
`;
/** Draws a line around the selected objects, also where they are hidden, and a tint over them. */
export class Outline {
  private objects: readonly Object3D[] = [];
  private readonly mask = new WebGLRenderTarget(1, 1, { samples: 4 });
  private readonly maskMaterial = new MeshBasicMaterial({ color: 0xffffff, side: DoubleSide });
  private readonly uniforms = {
    mask: { value: this.mask.texture },
    texel: { value: new Vector2() },
    color: { value: new Color() },
    fill: { value: 0 },
    strength: { value: 1 },
  };

  private readonly quad = new ScreenQuad(
    new ShaderMaterial({
      vertexShader: SCREEN_VERTEX,
      fragmentShader: FRAGMENT_SHADER,
      uniforms: this.uniforms,
      transparent: true,
      depthTest: false,
      depthWrite: false,
    }),
  );

  constructor(
    private readonly viewport: Viewport,
    private readonly look = SELECTION_LOOK,
  ) {
    this.uniforms.color.value.setHex(look.color);
    this.uniforms.fill.value = look.fill;
  }

  /** The opacity of the outline: 1 full, 0 none. */
  set strength(strength: number) {
    this.uniforms.strength.value = strength;
  }

  set(objects: readonly Object3D[]): void {
    for (const object of this.objects) object.layers.disable(this.look.layer);
    for (const object of objects) object.layers.enable(this.look.layer);
    this.objects = objects;
  }

  /** Draws over the frame just rendered. */
  render(): void {
    if (this.objects.length === 0) return;
    const { renderer, scene, camera } = this.viewport;
    const size = renderer.getDrawingBufferSize(new Vector2());
    const background = renderer.getClearColor(new Color());
    this.mask.setSize(size.x, size.y);
    const width = renderer.getPixelRatio() * LINE_WIDTH_PX;
    this.uniforms.texel.value.set(width / size.x, width / size.y);
    renderer.setClearColor(0x000000);
    renderer.setRenderTarget(this.mask);
    scene.overrideMaterial = this.maskMaterial;
    camera.layers.set(this.look.layer);
    renderer.render(scene, camera);
    camera.layers.set(0);
    scene.overrideMaterial = null;
    renderer.setRenderTarget(null);
    renderer.setClearColor(background);
    this.quad.render(renderer);
  }
}
