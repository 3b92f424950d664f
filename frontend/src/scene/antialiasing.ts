import { ShaderMaterial, Vector2, WebGLRenderTarget, type WebGLRenderer } from "three";
import { SCREEN_VERTEX, ScreenQuad } from "./objects/screen-quad";

const SAMPLE_COUNT = 4;
const FRAGMENT_SHADER = /* glsl */ `
  uniform sampler2D source;
  varying vec2 vUv;
  void main() { gl_FragColor = vec4(texture2D(source, vUv).rgb, 1.0); }
`;

/** Antialiasing that can be switched off for single frames, unlike the browser's own. */
export class Antialiasing {
  private readonly target = new WebGLRenderTarget(1, 1, { samples: SAMPLE_COUNT });
  private readonly quad = new ScreenQuad(
    new ShaderMaterial({
      vertexShader: SCREEN_VERTEX,
      fragmentShader: FRAGMENT_SHADER,
      uniforms: { source: { value: this.target.texture } },
      depthTest: false,
      depthWrite: false,
    }),
  );
  private readonly size = new Vector2();

  /** Runs `draw` with antialiasing. */
  render(renderer: WebGLRenderer, draw: () => void): void {
    renderer.getDrawingBufferSize(this.size);
    if (this.target.width !== this.size.x || this.target.height !== this.size.y) {
      this.target.setSize(this.size.x, this.size.y);
    }
    renderer.setRenderTarget(this.target);
    draw();
    renderer.setRenderTarget(null);
    this.quad.render(renderer);
  }
}
