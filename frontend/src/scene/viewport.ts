import {
  AmbientLight,
  Color,
  ColorManagement,
  DirectionalLight,
  LinearSRGBColorSpace,
  PerspectiveCamera,
  Scene,
  Vector3,
  WebGLRenderer,
} from "three";
import { cameraAxes, FIELD_OF_VIEW } from "../state/orbit";
import type { ViewState } from "../state/view";
import { AMBIENT } from "./light";
import { Smoothing } from "./smoothing";

const LARGEST_PIXEL_RATIO = 2;
const FAR_CLIP = 1000;

// RViz writes colours to the screen as they are in the URDF; a surface facing the camera shows exactly its colour.
ColorManagement.enabled = false;

/** Canvas, camera and the light that follows the camera. */
export class Viewport {
  readonly scene = new Scene();
  readonly camera = new PerspectiveCamera((FIELD_OF_VIEW * 180) / Math.PI, 1, 0.01, FAR_CLIP);
  readonly renderer: WebGLRenderer;
  private readonly smoothing = new Smoothing();
  private readonly light = new DirectionalLight(0xffffff, (1 - AMBIENT) * Math.PI);

  constructor(readonly container: HTMLElement, resized: () => void) {
    this.renderer = new WebGLRenderer({ antialias: false, powerPreference: "high-performance" });
    // Asking whether the shaders compiled waits for them; only we could do something about it.
    this.renderer.debug.checkShaderErrors = import.meta.env.DEV;
    this.renderer.outputColorSpace = LinearSRGBColorSpace;
    this.renderer.setClearColor(0x303030);
    this.camera.matrixAutoUpdate = false;
    this.scene.add(new AmbientLight(0xffffff, AMBIENT * Math.PI), this.light, this.light.target);
    container.prepend(this.canvas);
    new ResizeObserver(() => {
      this.fit();
      resized();
    }).observe(container);
    this.fit();
  }

  get canvas(): HTMLCanvasElement {
    return this.renderer.domElement;
  }

  set background(color: string) {
    this.renderer.setClearColor(new Color(color));
  }

  /** Puts the camera where the view says. */
  aim(view: ViewState): void {
    const { orbit } = view;
    const { right, up, back } = cameraAxes(orbit);
    const target = view.targetPosition();
    const at = (i: 0 | 1 | 2): number => target[i] + orbit.focal[i] + back[i] * orbit.distance;
    this.camera.matrix
      .makeBasis(new Vector3(...right), new Vector3(...up), new Vector3(...back))
      .setPosition(at(0), at(1), at(2));
    this.camera.matrixWorldNeedsUpdate = true;
    const near = view.current.near_clip_distance;
    const far = Math.max(FAR_CLIP, orbit.distance * 10);
    if (this.camera.near !== near || this.camera.far !== far) {
      this.camera.near = near;
      this.camera.far = far;
      this.camera.updateProjectionMatrix();
    }
    this.light.position.set(...back);
  }

  /** Draws the scene; `fine` smooths its edges. */
  render(fine: boolean): void {
    const draw = (): void => this.renderer.render(this.scene, this.camera);
    if (fine) this.smoothing.render(this.renderer, draw);
    else draw();
  }


  private fit(): void {
    const width = Math.max(1, this.container.clientWidth);
    const height = Math.max(1, this.container.clientHeight);
    this.renderer.setPixelRatio(Math.min(window.devicePixelRatio, LARGEST_PIXEL_RATIO));
    this.renderer.setSize(width, height);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
  }
}
