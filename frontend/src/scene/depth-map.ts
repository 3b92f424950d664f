import { DepthTexture, ShaderMaterial, UnsignedIntType, Vector2, Vector3, WebGLRenderTarget, type Camera } from "three";
import { SCREEN_VERTEX, ScreenQuad } from "./objects/screen-quad";
import type { Viewport } from "./viewport";

/** A surface hides a point if it is nearer by more than this share of the point's distance. */
const TOLERANCE = 0.01;
const FRAGMENT_SHADER = /* glsl */ `
  uniform sampler2D depths;
  varying vec2 vUv;
  void main() {
    vec4 parts = fract(texture2D(depths, vUv).r * vec4(1.0, 255.0, 65025.0, 16581375.0));
    gl_FragColor = parts - parts.yzww * vec4(1.0 / 255.0, 1.0 / 255.0, 1.0 / 255.0, 0.0);
  }
`;

/** The distance of the nearest surface at each pixel of the scene; anything behind it is hidden. */
export class DepthMap {
  private readonly pixels: Uint8Array;
  private readonly size: Vector2;
  private readonly camera: Camera;
  private readonly point = new Vector3();

  /** Renders the depths of the scene off screen; the camera must be up to date. Transparent objects hide nothing. */
  constructor({ renderer, scene, camera, size }: Viewport) {
    this.camera = camera;
    this.size = new Vector2(size.width, size.height).floor();
    const { x: width, y: height } = this.size;
    const target = new WebGLRenderTarget(width, height, {
      depthTexture: new DepthTexture(width, height, UnsignedIntType),
    });
    const packedTarget = new WebGLRenderTarget(width, height);
    const quad = new ScreenQuad(
      new ShaderMaterial({
        vertexShader: SCREEN_VERTEX,
        fragmentShader: FRAGMENT_SHADER,
        uniforms: { depths: { value: target.depthTexture } },
        depthTest: false,
        depthWrite: false,
      }),
    );
    renderer.setRenderTarget(target);
    renderer.render(scene, camera);
    renderer.setRenderTarget(packedTarget);
    quad.render(renderer);
    this.pixels = new Uint8Array(width * height * 4);
    renderer.readRenderTargetPixels(packedTarget, 0, 0, width, height, this.pixels);
    renderer.setRenderTarget(null);
    quad.dispose();
    target.dispose();
    packedTarget.dispose();
  }

  /** Whether a point, in normalized device coordinates (-1 to 1, y up), is not hidden. */
  isVisible(x: number, y: number, z: number): boolean {
    const column = Math.round(((x + 1) / 2) * this.size.x - 0.5);
    const row = Math.round(((y + 1) / 2) * this.size.y - 0.5);
    const distance = this.toDistance(z);
    // Check the neighbors, too: points on an edge fall next to their surface as often as on it.
    for (let dy = -1; dy <= 1; dy++) {
      for (let dx = -1; dx <= 1; dx++) {
        if (this.readDistance(column + dx, row + dy) >= distance * (1 - TOLERANCE)) return true;
      }
    }
    return false;
  }

  /** Returns the distance from the camera to the nearest surface at a pixel, m along the viewing axis. */
  private readDistance(column: number, row: number): number {
    if (column < 0 || row < 0 || column >= this.size.x || row >= this.size.y) return 0;
    const firstByte = (row * this.size.x + column) * 4;
    const [a = 0, b = 0, c = 0, d = 0] = this.pixels.subarray(firstByte, firstByte + 4);
    return this.toDistance(2 * ((a + b / 255 + c / 65025 + d / 16581375) / 255) - 1);
  }

  private toDistance(z: number): number {
    return -this.point.set(0, 0, z).applyMatrix4(this.camera.projectionMatrixInverse).z;
  }
}
