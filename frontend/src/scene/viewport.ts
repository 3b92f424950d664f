import {
  AmbientLight,
  Color,
  ColorManagement,
  DirectionalLight,
  LinearSRGBColorSpace,
  OrthographicCamera,
  PCFShadowMap,
  PerspectiveCamera,
  Scene,
  Vector3,
  WebGLRenderer,
} from "three";
import type { ViewState } from "../state/view";
import { FIELD_OF_VIEW_RAD, type Camera, type ViewSize } from "../state/views/camera";
import { readNumber } from "../state/views/view-controller";
import { distanceBetween } from "../state/views/vector";
import { AMBIENT_SHARE } from "./light";
import { Antialiasing } from "./antialiasing";
import { SkyAndFog, type OwnLight } from "./surroundings";

const MAX_PIXEL_RATIO = 2;
const FAR_CLIP_M = 1000;
/**
 * The largest ratio of the distance and the near clip distance; from farther away, the near clip distance grows,
 * because depths become imprecise.
 */
const MAX_DEPTH_RATIO = 2000;
/** The intensity of the camera's light while lights in the scene are used. */
const FAINT_LIGHT_INTENSITY = 0.15;
const NO_SURROUNDINGS = { background: null, daylight: null, fog: null };
/** The names of renderers that run on the CPU. */
const SOFTWARE_RENDERERS = /swiftshader|llvmpipe|softpipe|software|basic render/i;
/** The longest side of a screenshot, pixels. */
const MAX_SCREENSHOT_PX = 8192;

// RViz writes colors to the screen as in the URDF; a surface facing the camera has exactly its color.
ColorManagement.enabled = false;

/** The canvas, its camera, and the light that follows the camera. */
export class Viewport {
  readonly scene = new Scene();
  private readonly perspective = new PerspectiveCamera((FIELD_OF_VIEW_RAD * 180) / Math.PI, 1, 0.01, FAR_CLIP_M);
  private readonly orthographic = new OrthographicCamera();
  private activeCamera: PerspectiveCamera | OrthographicCamera = this.perspective;
  readonly renderer: WebGLRenderer;
  private readonly antialiasing = new Antialiasing();
  private currentShare = 1;
  /** The shift of the camera's center to the left of the canvas's center, pixels. */
  shiftLeft = 0;
  /** The shift of the camera's center downwards, pixels. */
  shiftDown = 0;
  private readonly ambient = new AmbientLight(0xffffff, AMBIENT_SHARE * Math.PI);
  private readonly surroundings = new SkyAndFog(this.scene);
  private ownBackground = "#303030";
  private rendererName: string | null = null;
  /** Whether frames were late. It stays set, because light that changes back and forth is worse than either light. */
  isSlow = false;
  private readonly headlight = new DirectionalLight(0xffffff, (1 - AMBIENT_SHARE) * Math.PI);

  constructor(readonly container: HTMLElement, onResized: () => void) {
    this.renderer = createRenderer();
    // Reading the result of compilation blocks until shaders are compiled, and only developers can act on it.
    this.renderer.debug.checkShaderErrors = import.meta.env.DEV;
    this.renderer.outputColorSpace = LinearSRGBColorSpace;
    this.renderer.setClearColor(0x303030);
    this.perspective.matrixAutoUpdate = this.orthographic.matrixAutoUpdate = false;
    this.renderer.shadowMap.type = PCFShadowMap;
    this.scene.add(this.ambient, this.headlight, this.headlight.target);
    // Before the first frame, the canvas is black: hide it so that its container shows.
    this.canvas.style.visibility = "hidden";
    container.prepend(this.canvas);
    new ResizeObserver(() => {
      this.resize();
      onResized();
    }).observe(container);
    this.resize();
  }

  get canvas(): HTMLCanvasElement {
    return this.renderer.domElement;
  }

  set background(color: string) {
    this.ownBackground = color;
    this.renderer.setClearColor(new Color(color));
  }

  /** Whether a light with shadows would not make the page slow: a GPU draws, and was not found slow. */
  get canAffordStudio(): boolean {
    return this.softwareRenderer === null && !this.isSlow;
  }

  /** The name of a renderer on the CPU; null if a GPU draws. */
  get softwareRenderer(): string | null {
    this.rendererName ??= readRendererName(this.renderer.getContext());
    return SOFTWARE_RENDERERS.test(this.rendererName) ? (/SwiftShader|llvmpipe|softpipe|Basic Render/i.exec(this.rendererName)?.[0] ?? this.rendererName) : null;
  }

  /**
   * Lights the scene: by the camera's light (null), or by lights in the scene, which leave the camera a faint light.
   */
  applyLight(ownLight: OwnLight | null): void {
    const { renderer } = this;
    this.headlight.intensity = (ownLight ? FAINT_LIGHT_INTENSITY : 1 - AMBIENT_SHARE) * Math.PI;
    this.ambient.intensity = ownLight ? 0 : AMBIENT_SHARE * Math.PI;
    renderer.shadowMap.enabled = ownLight?.hasShadows ?? false;
    renderer.setClearColor(new Color(ownLight?.background ?? this.ownBackground));
    this.surroundings.apply(ownLight ?? NO_SURROUNDINGS, this.activeCamera === this.orthographic);
  }

  /** The current camera: views differ in their projection. */
  get camera(): PerspectiveCamera | OrthographicCamera {
    return this.activeCamera;
  }

  /** Moves the camera to the pose of the view. */
  aim(view: ViewState): void {
    const viewCamera = view.camera;
    this.activeCamera = viewCamera.scale === null ? this.perspective : this.orthographic;
    this.updateProjection(viewCamera, readNumber(view.values, "Near Clip Distance", 0.01));
    this.applyShift();
    this.activeCamera.matrix
      .makeBasis(new Vector3(...viewCamera.right), new Vector3(...viewCamera.up), new Vector3(...viewCamera.back))
      .setPosition(...viewCamera.position);
    this.activeCamera.updateMatrixWorld(true);
    this.headlight.position.set(...viewCamera.back);
  }

  /** The share of the screen's pixels drawn along each side; the size of the image on the page does not change. */
  set resolutionShare(resolutionShare: number) {
    if (resolutionShare === this.currentShare) return;
    this.currentShare = resolutionShare;
    this.resize();
  }

  /** The size of the canvas, CSS pixels. */
  get size(): ViewSize {
    return { width: Math.max(1, this.canvas.clientWidth), height: Math.max(1, this.canvas.clientHeight) };
  }

  /** The camera of the next frame, and the height of the frame in its own pixels. */
  get drawnView(): { camera: PerspectiveCamera | OrthographicCamera; height: number } {
    return { camera: this.activeCamera, height: this.canvas.height };
  }

  /** Draws the scene; with antialiasing if `isFine`. */
  render(isFine: boolean): void {
    const draw = (): void => this.renderer.render(this.scene, this.camera);
    if (isFine) this.antialiasing.render(this.renderer, draw);
    else draw();
    this.canvas.style.visibility = "";
  }

  /** Returns the scene as PNG, enlarged by `scale` relative to the canvas, as far as the GPU permits. */
  takeScreenshot(scale: number): Promise<Blob | null> {
    const { renderer, canvas } = this;
    const { width, height } = this.size;
    const maxScale = Math.min(renderer.capabilities.maxTextureSize, MAX_SCREENSHOT_PX) / Math.max(width, height);
    renderer.setPixelRatio(Math.min(scale, maxScale));
    renderer.setSize(width, height, false);
    this.render(true);
    // The frame is available only until the browser regains control.
    const screenshot = new Promise<Blob | null>((resolve) => canvas.toBlob(resolve, "image/png"));
    this.resize();
    return screenshot;
  }

  private updateProjection(viewCamera: Camera, nearDistance: number): void {
    const { perspective, orthographic } = this;
    const { width, height } = this.size;
    if (viewCamera.scale !== null) {
      const [x, y] = [width / viewCamera.scale / 2, height / viewCamera.scale / 2];
      Object.assign(orthographic, { left: -x, right: x, bottom: -y, top: y, near: nearDistance, far: FAR_CLIP_M });
      orthographic.updateProjectionMatrix();
      return;
    }
    const distance = viewCamera.focal ? distanceBetween(viewCamera.position, viewCamera.focal) : 0;
    const clip = { near: Math.max(nearDistance, distance / MAX_DEPTH_RATIO), far: Math.max(FAR_CLIP_M, distance * 10) };
    Object.assign(perspective, { aspect: width / height, ...clip });
    perspective.updateProjectionMatrix();
  }

  private applyShift(): void {
    const { width, height } = this.size;
    if (this.shiftLeft !== 0 || this.shiftDown !== 0) this.activeCamera.setViewOffset(width, height, this.shiftLeft, -this.shiftDown, width, height);
    else if (this.activeCamera.view?.enabled === true) this.activeCamera.clearViewOffset();
  }

  private resize(): void {
    const width = Math.max(1, this.container.clientWidth);
    const height = Math.max(1, this.container.clientHeight);
    this.renderer.setPixelRatio(Math.min(window.devicePixelRatio, MAX_PIXEL_RATIO) * this.currentShare);
    this.renderer.setSize(width, height);
  }
}

/**
 * Creates the renderer. Its canvas is opaque, which spares the browser from drawing what is behind; three.js has no
 * option for that.
 */
function createRenderer(): WebGLRenderer {
  const canvas = document.createElement("canvas");
  const options = { antialias: false, powerPreference: "high-performance" } as const;
  const context = canvas.getContext("webgl2", { ...options, alpha: false });
  return new WebGLRenderer(context ? { ...options, canvas, context } : options);
}

/** Returns the name of the renderer from the graphics driver; empty if the browser does not reveal it. */
function readRendererName(gl: WebGLRenderingContext | WebGL2RenderingContext): string {
  const extension = gl.getExtension("WEBGL_debug_renderer_info");
  return String(gl.getParameter(extension ? extension.UNMASKED_RENDERER_WEBGL : gl.RENDERER));
}
