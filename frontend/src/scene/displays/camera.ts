import { Camera, Group, Matrix4 } from "three";
import type { DisplayData } from "../../connection/data";
import type { CameraModel } from "../../protocol";
import { strings } from "../../strings";
import { createCameraPose, computeZoom, createProjection } from "../images/camera-projection";
import { OwnPanel } from "../images/own-panel";
import { ImageCanvas } from "../images/image-canvas";
import { SceneImage } from "../images/scene-image";
import { isShownInCamera } from "../images/shown-in-camera";
import { readDataPose } from "../pose";
import type { Drawing, DrawingContext, DrawnScene } from "./drawing";

/** rviz_default_plugins/Camera: a panel with the scene as a camera sees it, combined with the camera's image. */
export class CameraDrawing implements Drawing {
  readonly root = new Group();
  private readonly image = new ImageCanvas();
  private readonly scene = new SceneImage();
  private readonly canvas = document.createElement("canvas");
  private readonly panel: OwnPanel;
  private readonly camera = new Camera();
  private data: DisplayData | null = null;
  private model: CameraModel | null = null;
  private nextDrawMs = 0;
  private retryTimer = 0;
  private readonly resizeObserver: ResizeObserver;

  constructor(private readonly context: DrawingContext) {
    this.camera.matrixAutoUpdate = false;
    this.panel = new OwnPanel(context, "camera", this.canvas);
    this.panel.showText(strings.images.none);
    this.panel.update();
    this.resizeObserver = new ResizeObserver(() => this.context.invalidate());
    this.resizeObserver.observe(this.panel.element);
  }

  onPropertiesChanged(): void {
    this.panel.update();
  }

  onDataChanged(data: DisplayData): void {
    const { content } = data;
    if (content.kind !== "image_frame") return;
    this.data = data;
    this.model = content.camera;
    this.image.show(content, (isReadable) => {
      if (!isReadable) this.panel.showText(strings.images.unreadable);
      else this.panel.showText(this.model ? "" : strings.images.noCameraInfo);
      this.context.invalidate();
    });
  }

  onDataRemoved(): void {
    this.data = this.model = null;
    this.image.clear();
    this.canvas.width = this.canvas.height = 0;
    this.panel.showText(strings.images.none);
  }

  update(): void {
    // The display draws nothing into the scene; `afterFrame` draws the panel.
  }

  afterFrame(scene: DrawnScene): void {
    const { data, model } = this;
    const { element } = this.panel;
    if (!data || !model || !this.panel.isVisible || !this.canDrawNow()) return;
    const startMs = performance.now();
    if (!readDataPose(this.context.session.frames, data, this.camera.matrix)) return;
    const { rows } = this.context.display;
    const [width, height] = [element.clientWidth, element.clientHeight];
    const zoom = computeZoom(model, rows.number(1, "Zoom Factor"), width, height);
    this.camera.matrix.multiply(createCameraPose(model));
    this.camera.matrixWorldNeedsUpdate = true;
    this.camera.projectionMatrix.copy(createProjection(model, zoom, rows.number(100, "Far Plane Distance")));
    this.camera.projectionMatrixInverse.copy(this.camera.projectionMatrix).invert();
    scene.drawOnly(
      (display) => isShownInCamera(rows, display),
      () => this.scene.draw(scene.renderer, scene.scene, this.camera, width, height),
    );
    this.compose(scene, zoom, width, height);
    const now = performance.now();
    this.nextDrawMs = now + (now - startMs);
  }

  inspect(): object {
    const context = this.canvas.getContext("2d");
    const { width, height } = this.canvas;
    const pixelAt = (x: number, y: number): number[] =>
      width > 0 && context ? [...context.getImageData(Math.floor(x * width), Math.floor(y * height), 1, 1).data] : [];
    return {
      width,
      height,
      image: [this.image.canvas.width, this.image.canvas.height],
      middle: pixelAt(0.5, 0.5),
      position: new Matrix4().copy(this.camera.matrix).elements.slice(12, 15),
    };
  }

  dispose(): void {
    this.resizeObserver.disconnect();
    clearTimeout(this.retryTimer);
    this.panel.close();
    this.scene.dispose();
  }

  /**
   * Returns whether to draw now. Drawing the scene a second time may take at most half of the time; a skipped image is
   * drawn later.
   */
  private canDrawNow(): boolean {
    const waitMs = this.nextDrawMs - performance.now();
    if (waitMs <= 0) return true;
    clearTimeout(this.retryTimer);
    this.retryTimer = window.setTimeout(this.context.invalidate, waitMs);
    return false;
  }

  /** Draws the background image, the scene, and the overlay image. */
  private compose(scene: DrawnScene, zoom: readonly [number, number], width: number, height: number): void {
    const { rows } = this.context.display;
    const layers = rows.text("background and overlay", "Image Rendering");
    if (this.canvas.width !== width) this.canvas.width = width;
    if (this.canvas.height !== height) this.canvas.height = height;
    const context = this.canvas.getContext("2d");
    if (!context) return;
    const [imageWidth, imageHeight] = [width * zoom[0], height * zoom[1]];
    const drawImage = (alpha: number): void => {
      if (this.image.isEmpty) return;
      context.globalAlpha = alpha;
      context.imageSmoothingEnabled = false;
      context.drawImage(this.image.canvas, (width - imageWidth) / 2, (height - imageHeight) / 2, imageWidth, imageHeight);
      context.globalAlpha = 1;
    };
    context.fillStyle = scene.background;
    context.fillRect(0, 0, width, height);
    if (layers !== "overlay") drawImage(1);
    context.drawImage(this.scene.canvas, 0, 0);
    if (layers !== "background") drawImage(rows.number(0.5, "Overlay Alpha"));
  }
}
