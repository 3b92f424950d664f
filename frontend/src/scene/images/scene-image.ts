import { Color, LinearSRGBColorSpace, WebGLRenderTarget, type Camera, type Scene, type WebGLRenderer } from "three";

/**
 * The scene rendered to a canvas of its own, transparent where nothing is drawn, and without antialiasing to be fast.
 */
export class SceneImage {
  readonly canvas = document.createElement("canvas");
  private readonly target = new WebGLRenderTarget(1, 1, { colorSpace: LinearSRGBColorSpace });
  private bytes = new Uint8Array(0);
  private readonly context: CanvasRenderingContext2D;

  constructor() {
    const context = this.canvas.getContext("2d");
    if (!context) throw new Error("This browser does not support the 2D canvas");
    this.context = context;
  }

  /** Renders the scene for a camera; sizes in pixels. */
  draw(renderer: WebGLRenderer, scene: Scene, camera: Camera, width: number, height: number): void {
    if (this.canvas.width !== width || this.canvas.height !== height) {
      this.canvas.width = width;
      this.canvas.height = height;
      this.target.setSize(width, height);
      this.bytes = new Uint8Array(width * height * 4);
    }
    const [color, alpha] = [renderer.getClearColor(new Color()), renderer.getClearAlpha()];
    renderer.setClearColor(0x000000, 0);
    renderer.setRenderTarget(this.target);
    renderer.clear();
    renderer.render(scene, camera);
    renderer.readRenderTargetPixels(this.target, 0, 0, width, height, this.bytes);
    renderer.setRenderTarget(null);
    renderer.setClearColor(color, alpha);
    this.context.putImageData(toImageData(this.bytes, width, height), 0, 0);
  }

  dispose(): void {
    this.target.dispose();
  }
}

/** Returns an image with rows from the top and colors not premultiplied by alpha, as canvases expect. */
function toImageData(bytes: Uint8Array, width: number, height: number): ImageData {
  const image = new ImageData(width, height);
  const { data } = image;
  const rowBytes = width * 4;
  for (let y = 0; y < height; y++) data.set(bytes.subarray((height - 1 - y) * rowBytes, (height - y) * rowBytes), y * rowBytes);
  for (let i = 3; i < data.length; i += 4) {
    const alpha = data[i] ?? 0;
    if (alpha === 0 || alpha === 255) continue;
    for (let channel = i - 3; channel < i; channel++) data[channel] = ((data[channel] ?? 0) * 255) / alpha;
  }
  return image;
}
