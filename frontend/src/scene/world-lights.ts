import {
  AmbientLight,
  Box3,
  Color,
  DirectionalLight,
  Group,
  Light,
  Matrix4,
  PointLight,
  SpotLight,
  Vector3,
  type Object3D,
} from "three";
import type { LightScene, WorldScene } from "../protocol";
import type { PropertyRows } from "../state/properties";
import { usesSceneLights, type Lighting } from "./light";
import { aimSun, enableShadows, FULL_INTENSITY, setShadowed, STUDIO_DIRECTION, STUDIO_LAMP_INTENSITY, createStudioSky } from "./studio-light";

/** The maximum radius around the center of the drawn objects in which shadows are drawn, m. */
const MAX_SHADOW_RADIUS_M = 25;
/** The assumed distance between a lamp and the objects that it lights, m. */
const TYPICAL_DISTANCE_M = 3;
/** The maximum number of lights with shadows, each of which needs another rendering of the scene. */
const MAX_SHADOW_LIGHTS = 2;
/** The maximum number of lights of a world, each of which costs time for every pixel. */
const MAX_LIGHTS = 8;

/** The lights of a world, at their poses in the fixed frame. */
export class WorldLights {
  readonly root = new Group();
  private placedLights: { light: Light; spec: LightScene }[] = [];
  private builtKey = "";
  private chosenLighting: Lighting = "Camera";
  private isShadowed = false;

  constructor(private readonly canAffordStudio: () => boolean) {
    this.root.matrixAutoUpdate = false;
  }

  /** Applies the properties of the display and its world. */
  applyProperties(rows: PropertyRows, scene: WorldScene): void {
    const choice = rows.text("Automatic", "Light");
    this.chosenLighting = choice === "Studio" || choice === "World" || choice === "Camera" ? choice : this.canAffordStudio() ? "Studio" : "Soft";
    this.isShadowed = this.isLit && rows.bool(true, "Shadows") && (this.chosenLighting === "Studio" || scene.shadows);
    const key = [this.chosenLighting, this.isShadowed, scene.revision].join();
    if (key === this.builtKey) return;
    this.builtKey = key;
    this.clear();
    if (this.chosenLighting === "Studio") this.buildStudio();
    else if (this.chosenLighting === "World") this.buildWorld(scene);
  }

  /** Whether lights in the scene replace the camera's light. */
  get isLit(): boolean {
    return usesSceneLights(this.chosenLighting);
  }

  get lighting(): Lighting {
    return this.chosenLighting;
  }

  get castsShadows(): boolean {
    return this.isShadowed;
  }

  /** Whether the world's own lights are used. */
  get usesWorldLights(): boolean {
    return this.chosenLighting === "World";
  }

  /** Returns the background color of the world. */
  backgroundOf(scene: WorldScene): string {
    const [r = 0, g = 0, b = 0] = scene.background;
    return `#${new Color(r, g, b).getHexString()}`;
  }

  /** Moves the lights to the poses of their links, and fits shadows to the drawn objects. */
  updatePoses(world: Matrix4, poseOf: (link: string) => Matrix4 | null, computeBounds: () => Box3): void {
    if (!this.isLit) return;
    for (const { light, spec } of this.placedLights) {
      const frame = spec.link === null ? world : poseOf(spec.link);
      light.visible = frame !== null;
      if (!frame) continue;
      light.position.fromArray(spec.position).applyMatrix4(frame);
      const direction = new Vector3().fromArray(spec.direction).transformDirection(frame);
      if (light instanceof SpotLight || light instanceof DirectionalLight) light.target.position.copy(light.position).add(direction);
      if (light instanceof DirectionalLight) this.aimLight(light, direction, computeBounds);
    }
  }

  /** Sets whether objects cast and receive shadows. */
  setShadows(root: Object3D): void {
    setShadowed(root, this.isShadowed);
  }

  /** Returns the lights in use, for tests. */
  inspect(): object {
    const shadows = this.placedLights.filter(({ light }) => light.castShadow).length;
    return { lighting: this.chosenLighting, lights: this.placedLights.length, shadows };
  }

  dispose(): void {
    this.clear();
  }

  private clear(): void {
    this.root.traverse((object) => {
      if (object instanceof Light) object.dispose();
    });
    this.root.clear();
    this.placedLights = [];
  }

  private buildStudio(): void {
    this.root.add(createStudioSky());
    const spec: LightScene = {
      kind: "directional",
      link: null,
      position: [0, 0, 0],
      direction: STUDIO_DIRECTION.toArray(),
      color: [STUDIO_LAMP_INTENSITY, STUDIO_LAMP_INTENSITY, STUDIO_LAMP_INTENSITY],
      shadows: true,
      range: 0,
      fading: [1, 0, 0],
      cone: [0, 0],
    };
    this.addLight(new DirectionalLight(), spec);
  }

  private buildWorld(scene: WorldScene): void {
    const [r = 0, g = 0, b = 0] = scene.ambient;
    this.root.add(new AmbientLight(new Color(r, g, b), FULL_INTENSITY));
    for (const spec of scene.lights.slice(0, MAX_LIGHTS)) this.addLight(createLight(spec), spec);
  }

  private addLight(light: DirectionalLight | PointLight | SpotLight, spec: LightScene): void {
    const [r = 0, g = 0, b = 0] = spec.color;
    light.color.setRGB(r, g, b);
    light.intensity = FULL_INTENSITY * computeIntensity(spec);
    const shadows = this.placedLights.filter((placedLight) => placedLight.light.castShadow).length;
    if (this.isShadowed && spec.shadows && shadows < MAX_SHADOW_LIGHTS && !(light instanceof PointLight)) {
      enableShadows(light);
    }
    this.root.add(light);
    if (!(light instanceof PointLight)) this.root.add(light.target);
    this.placedLights.push({ light, spec });
  }

  /** Aims a sun from just outside the drawn objects, so that its shadows have the highest resolution. */
  private aimLight(light: DirectionalLight, direction: Vector3, computeBounds: () => Box3): void {
    const box = light.castShadow ? computeBounds() : new Box3();
    if (box.isEmpty()) {
      light.position.copy(direction).negate();
      light.target.position.set(0, 0, 0);
      return;
    }
    const radius = Math.min(box.getSize(new Vector3()).length() / 2, MAX_SHADOW_RADIUS_M);
    aimSun(light, direction, box.getCenter(new Vector3()), radius);
  }
}

/** Returns the intensity of a light at a typical distance, which is used for all distances up to its range. */
function computeIntensity({ kind, range, fading }: LightScene): number {
  if (kind === "directional") return 1;
  const [constant = 1, linear = 0, quadratic = 0] = fading;
  const distance = Math.min(range / 2, TYPICAL_DISTANCE_M);
  return Math.min(1, 1 / Math.max(constant + linear * distance + quadratic * distance ** 2, 1e-3));
}

function createLight(spec: LightScene): DirectionalLight | PointLight | SpotLight {
  if (spec.kind === "directional") return new DirectionalLight();
  if (spec.kind === "point") return new PointLight(0xffffff, 1, spec.range, 0);
  const [innerAngle = 0, outerAngle = 0] = spec.cone;
  const angle = Math.min(outerAngle > 0 ? outerAngle / 2 : Math.PI / 4, Math.PI / 2);
  const penumbra = outerAngle > 0 ? Math.min(Math.max(1 - innerAngle / outerAngle, 0), 1) : 0;
  return new SpotLight(0xffffff, 1, spec.range, angle, penumbra, 0);
}
