import {
  DirectionalLight,
  Group,
  HemisphereLight,
  Mesh,
  PlaneGeometry,
  ShadowMaterial,
  Vector3,
  type Box3,
  type Object3D,
  type SpotLight,
} from "three";

/** The light intensity at which a surface facing the light has exactly its own color. */
export const FULL_INTENSITY = Math.PI;
/** The intensity of the studio's lamp, and its direction in worlds. */
export const STUDIO_LAMP_INTENSITY = 0.74;
export const STUDIO_DIRECTION = new Vector3(0.45, 0.6, -1).normalize();
/** Robots face along x and are first viewed from between x and y: the lamp is in front of them, on that side. */
const ROBOT_DIRECTION = new Vector3(-0.8, -0.15, -1).normalize();
const STUDIO_SKY_INTENSITY = 0.42;
const STUDIO_GROUND_INTENSITY = 0.16;
/** Pixels along each side of a shadow map. */
const SHADOW_MAP_SIZE_PX = 2048;
/** The width of a shadow's edge in pixels of the map, which are small around a robot. */
const [SHADOW_EDGE_PX, ROBOT_SHADOW_EDGE_PX] = [3, 8];
/** The darkness of shadows on the ground. */
const SHADOW_OPACITY = 0.35;
/** The width of the ground that receives shadows, in sizes of the objects on it. */
const GROUND_WIDTH = 6;

/** Returns light from all directions, brighter from above. */
export function createStudioSky(): HemisphereLight {
  const sky = new HemisphereLight(0xffffff, 0xffffff, STUDIO_SKY_INTENSITY * FULL_INTENSITY);
  sky.groundColor.setScalar(STUDIO_GROUND_INTENSITY / STUDIO_SKY_INTENSITY);
  sky.position.set(0, 0, 1);
  return sky;
}

/** Makes a light cast shadows with soft edges. */
export function enableShadows(light: DirectionalLight | SpotLight): void {
  light.castShadow = true;
  light.shadow.mapSize.set(SHADOW_MAP_SIZE_PX, SHADOW_MAP_SIZE_PX);
  light.shadow.bias = -0.0005;
  light.shadow.normalBias = 0.02;
  light.shadow.radius = SHADOW_EDGE_PX;
}

/** Places a sun just outside a sphere, so that the shadows within it have the highest resolution. */
export function aimSun(light: DirectionalLight, direction: Vector3, center: Vector3, radius: number): void {
  light.target.position.copy(center);
  light.position.copy(center).addScaledVector(direction, -2 * radius);
  const { camera } = light.shadow;
  Object.assign(camera, { left: -radius, right: radius, top: radius, bottom: -radius, near: radius / 10, far: 4 * radius });
  camera.updateProjectionMatrix();
}

/** Sets whether objects cast and receive shadows. */
export function setShadowed(root: Object3D, isShadowed: boolean): void {
  root.traverse((object) => {
    if (object instanceof Mesh) object.castShadow = object.receiveShadow = isShadowed;
  });
}

/** A lamp from the side, light from the sky, and a ground that is visible only in shadows. */
export class StudioLight {
  readonly root = new Group();
  private readonly lamp = new DirectionalLight(0xffffff, STUDIO_LAMP_INTENSITY * FULL_INTENSITY);
  private readonly ground = new Mesh(
    new PlaneGeometry(),
    new ShadowMaterial({ opacity: SHADOW_OPACITY, depthWrite: false, polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1 }),
  );

  constructor() {
    enableShadows(this.lamp);
    this.lamp.shadow.radius = ROBOT_SHADOW_EDGE_PX;
    this.ground.receiveShadow = true;
    this.root.add(createStudioSky(), this.lamp, this.lamp.target, this.ground);
    this.root.visible = false;
  }

  /** Lights the objects in a box, in the fixed frame, on a ground at this height, m. */
  update(box: Box3, height: number): void {
    this.ground.visible = !box.isEmpty();
    if (box.isEmpty()) return;
    const center = box.getCenter(new Vector3());
    const radius = box.getSize(new Vector3()).length() / 2;
    // Include the shadow of the highest point.
    aimSun(this.lamp, ROBOT_DIRECTION, center, 1.5 * radius);
    this.lamp.shadow.normalBias = radius / 100;
    this.ground.position.set(center.x, center.y, height);
    this.ground.scale.setScalar(GROUND_WIDTH * radius);
  }
}
