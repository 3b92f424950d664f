import { Box3, Group, Matrix4, Vector3, type Object3D, type Raycaster } from "three";
import type { DisplayData } from "../../connection/data";
import type { WorldPoses, WorldScene, WorldWater } from "../../protocol";
import type { DescriptionRow, Hit, SelectionBox } from "../picking";
import { readDataPose, setPoseMatrix } from "../pose";
import type { MovingView } from "../robot/moving-meshes";
import { RobotDrawing } from "../robot/robot-drawing";
import type { OwnLight } from "../surroundings";
import { WorldLights } from "../world-lights";
import type { Lighting } from "../light";
import type { Drawing, DrawingContext } from "./drawing";
import { findFreePosition } from "./free-position";
import { Displacement, modelOf } from "./world-models";
import { WorldSensors } from "./world-sensors";
import type { WaterSurface } from "./world-water";

/** The prefix of the keys of lidar rays. */
const RAYS_KEY_PREFIX = "rays ";
/** The key of the water. */
const WATER_KEY = "water";

/** A box flatter than this share of its width is taken for a ground. */
const GROUND_FLATNESS = 0.02;
/** An object this far below the ground has fallen out of the world, m. */
const FALLEN_Z_M = -1;

/** linkwright/World: the links of all models of a simulated world. */
export class WorldDrawing implements Drawing {
  readonly root = new Group();
  private drawing: RobotDrawing | null = null;
  private scene: WorldScene | null = null;
  private poses: { data: DisplayData; content: WorldPoses } | null = null;
  private rowByLink = new Map<string, number>();
  private readonly displacement = new Displacement();
  private isStyleStale = true;
  private isPoseStale = true;
  /** The last bounding box of everything visible, and that box extended to the origins of all links. */
  private visibleBox = new Box3();
  private shadowBox = new Box3();
  private readonly lights: WorldLights;
  private readonly sensors = new WorldSensors();
  private water: WorldWater | null = null;
  /** The drawing of the water, loaded with the first water; null while it is loading. */
  private waterSurface: WaterSurface | null | undefined;
  private isDisposed = false;

  constructor(private readonly context: DrawingContext) {
    this.root.matrixAutoUpdate = false;
    this.lights = new WorldLights(() => context.canAffordStudio());
    this.root.add(this.lights.root, this.sensors.root);
  }

  onDataChanged(data: DisplayData): void {
    const { content } = data;
    if (content.kind === "world_scene") this.setScene(content);
    else if (content.kind === "world_poses") {
      if (this.poses) this.displacement.clearIfPosesChanged(this.poses.content.poses, content.poses, this.rowByLink);
      this.poses = { data, content };
      this.isPoseStale = true;
    } else if (content.kind === "world_rays") {
      this.sensors.setRanges(content);
      this.isPoseStale = true;
    } else if (content.kind === "world_water") {
      this.water = content;
      if (this.waterSurface === undefined) void this.loadWaterSurface();
    }
  }

  onDataRemoved(key: string | null): void {
    if (key !== null) {
      if (key === WATER_KEY) this.water = null;
      if (key.startsWith(RAYS_KEY_PREFIX)) this.sensors.forget(key.slice(RAYS_KEY_PREFIX.length));
      return;
    }
    this.sensors.dispose();
    this.drawing?.dispose();
    this.drawing = this.scene = this.poses = this.water = null;
  }

  onPropertiesChanged(): void {
    this.isStyleStale = true;
  }

  update(): void {
    const { drawing, context } = this;
    this.updateWater();
    if (!drawing) return;
    if (this.poses?.data.pose === null) this.isPoseStale = true; // it follows its frame
    if (this.isStyleStale && this.scene) {
      this.lights.applyProperties(context.display.rows, this.scene);
      drawing.applyStyle(context.display.rows, context.session.inspect.current.contrast, this.lights.lighting);
      this.lights.setShadows(drawing.root);
      this.sensors.applyStyle(context.display.rows);
    }
    if (this.isStyleStale || this.isPoseStale) {
      this.placeLinks(drawing);
      this.sensors.placeSensors((link) => this.poseOf(link));
      this.lights.updatePoses(this.computeWorldPose(), (link) => this.poseOf(link), () => this.updateVisibleBox(drawing));
    }
    this.isStyleStale = this.isPoseStale = false;
    drawing.chooseDetail(context.getCamera());
  }

  simplify(view: MovingView | null): void {
    this.drawing?.simplify(view);
  }

  /** The lighting of the world. */
  get lighting(): Lighting {
    return this.lights.lighting;
  }

  /** The world's own light; null while the camera's light is used. */
  get ownLight(): OwnLight | null {
    if (!this.scene || !this.lights.isLit) return null;
    const isWorldLight = this.lights.usesWorldLights;
    const { daylight, fog } = this.scene;
    return {
      hasShadows: this.lights.castsShadows,
      background: isWorldLight ? this.lights.backgroundOf(this.scene) : null,
      daylight,
      fog: isWorldLight ? fog : null,
    };
  }

  /** Whether any part of the world has a pose. */
  get hasPose(): boolean {
    return this.drawing?.hasPose ?? false;
  }

  isSettled(): boolean {
    return (this.drawing?.isSettled ?? true) && this.waterSurface !== null;
  }

  computeBounds(): Box3 {
    return this.drawing?.computeBounds() ?? new Box3();
  }

  get hasRobots(): boolean {
    return (this.scene?.robots.length ?? 0) > 0;
  }

  /**
   * Returns the bounding boxes of the robots and of everything but grounds, without what has fallen, in the fixed
   * frame, m.
   */
  computeBoundsByKind(): { robots: Box3; world: Box3 } {
    const [robots, world, allBounds] = [new Box3(), new Box3(), new Box3()];
    const robotNames = new Set(this.scene?.robots);
    const boxes = [...(this.drawing?.boundsOfLinks() ?? [])].filter(([, box]) => !box.isEmpty());
    const lowestZ = Math.min(0, ...boxes.map(([link, box]) => (robotNames.has(modelOf(link)) ? 0 : box.min.z)));
    for (const [link, box] of boxes) {
      if (this.isFlat(link)) continue;
      if (robotNames.has(modelOf(link)) && box.max.z >= lowestZ + FALLEN_Z_M) robots.union(box);
      if (box.max.z < FALLEN_Z_M) continue;
      if (!isLikeGround(box)) world.union(box);
      allBounds.union(box);
    }
    return { robots, world: world.isEmpty() ? allBounds : world };
  }

  /** Returns a free position for a model, near the robots, in the frame of the world, m. */
  findFreePosition(): number[] {
    const { robots } = this.computeBoundsByKind();
    const robotCenter = robots.isEmpty() ? null : robots.getCenter(new Vector3());
    const robotNames = new Set(this.scene?.robots);
    // Ignore walls around the robot: their box contains the whole room.
    const surrounds = (link: string, box: Box3): boolean => robotCenter !== null && !robotNames.has(modelOf(link)) && box.containsPoint(robotCenter);
    const boxes = [...(this.drawing?.boundsOfLinks() ?? [])].filter(([link, box]) => !box.isEmpty() && !this.isFlat(link) && !isLikeGround(box) && !surrounds(link, box));
    return findFreePosition(boxes.map(([, box]) => box), this.computeWorldPose(), robotCenter);
  }

  /** Returns the pose of the file's camera, which looks along x, in the fixed frame; null if the file has none. */
  readCameraOfFile(): Matrix4 | null {
    const camera = this.scene?.camera;
    return camera ? setPoseMatrix(camera, new Matrix4()).premultiply(this.computeWorldPose()) : null;
  }

  /** Whether a ray hits a robot, or nothing within its range. */
  isClear(ray: Raycaster): boolean {
    const hit = this.pick(ray);
    return hit === null || (this.scene?.robots.includes(modelOf(hit.key)) ?? false);
  }

  pick(ray: Raycaster): Hit | null {
    return this.drawing?.pick(ray) ?? null;
  }

  pickBox(box: SelectionBox): readonly string[] {
    return this.drawing?.pickBox(box) ?? [];
  }

  describe(link: string): DescriptionRow | null {
    return this.drawing?.describe(link) ?? null;
  }

  objectsOf(link: string): readonly Object3D[] {
    return this.drawing?.objectsOf(link) ?? [];
  }

  positionOf(link: string): Vector3 | null {
    return this.drawing?.positionOf(link) ?? null;
  }

  /** Returns the pose of a link in the fixed frame; null until it is known. */
  poseOf(link: string): Matrix4 | null {
    return this.drawing?.poseOf(link) ?? null;
  }

  /** Returns the links of a top-level model of the world. */
  linksOf(model: string): string[] {
    return [...this.rowByLink.keys()].filter((link) => modelOf(link) === model);
  }

  /** Whether a link consists of planes only, as a ground does. */
  isFlat(link: string): boolean {
    const row = this.rowByLink.get(link);
    const visuals = (row === undefined ? null : this.scene?.links[row]?.visuals) ?? [];
    return visuals.every(({ kind }) => kind === "plane");
  }

  /**
   * Shows models away from their poses until their actual poses change; `models` has the matrices that premultiply the
   * poses.
   */
  displace(models: ReadonlyMap<string, Matrix4>): void {
    this.displacement.set(models);
    this.isPoseStale = true;
    this.context.invalidate();
  }

  /** Converts a direction from the fixed frame to the frame of the world. */
  transformToWorld(direction: Vector3): Vector3 {
    const length = direction.length();
    return direction.clone().transformDirection(this.computeWorldPose().invert()).multiplyScalar(length);
  }

  /** Converts a point from the fixed frame to the frame of the world, m. */
  pointToWorld(point: readonly number[]): number[] {
    return new Vector3().fromArray(point).applyMatrix4(this.computeWorldPose().invert()).toArray();
  }

  /** Returns the pose of the world in the fixed frame. */
  computeWorldPose(): Matrix4 {
    const pose = new Matrix4();
    if (this.poses) readDataPose(this.context.session.frames, this.poses.data, pose);
    return pose;
  }

  inspect(): object {
    return { revision: this.scene?.revision ?? 0, ...this.drawing?.inspect(), light: this.lights.inspect(), sensors: this.sensors.inspect(), water: this.water ? this.waterSurface?.inspect() ?? null : null };
  }

  dispose(): void {
    this.isDisposed = true;
    this.waterSurface?.dispose();
    this.drawing?.dispose();
    this.lights.dispose();
    this.sensors.dispose();
  }

  /** Returns the box for shadows. It is computed from all vertices only when a link has left it, not for each pose. */
  private updateVisibleBox(drawing: RobotDrawing): Box3 {
    const origins = (this.scene?.links ?? []).flatMap(({ name, visuals }) => (visuals.length > 0 ? drawing.positionOf(name) ?? [] : []));
    if (this.isStyleStale || !origins.every((origin) => this.shadowBox.containsPoint(origin))) {
      this.visibleBox = drawing.computeBounds();
      this.shadowBox = this.visibleBox.clone();
      for (const origin of origins) this.shadowBox.expandByPoint(origin);
    }
    return this.visibleBox;
  }

  private async loadWaterSurface(): Promise<void> {
    this.waterSurface = null;
    const { WaterSurface } = await import("./world-water");
    if (this.isDisposed) return;
    this.waterSurface = new WaterSurface();
    this.root.add(this.waterSurface.root);
    this.context.invalidate();
  }

  /** Draws the water at the time of the poses, so that bodies float on it. */
  private updateWater(): void {
    const { water, waterSurface, poses } = this;
    if (!waterSurface) return;
    waterSurface.root.visible = water !== null && poses !== null;
    if (water && poses) waterSurface.update(water, poses.data.stamp, this.context.getCamera(), this.computeWorldPose());
  }

  private placeLinks(drawing: RobotDrawing): void {
    const { poses: posedData, scene } = this;
    const pose = new Matrix4();
    const hasPoses = posedData !== null && posedData.content.revision === scene?.revision && readDataPose(this.context.session.frames, posedData.data, pose);
    if (!hasPoses) return;
    const { poses } = posedData.content;
    drawing.updatePoses((link, matrix) => {
      const row = this.rowByLink.get(link.name);
      if (row === undefined) return false;
      this.displacement.apply(link.name, setPoseMatrix(poses, matrix, row * 7)).premultiply(pose);
      return true;
    });
  }

  private setScene(scene: WorldScene): void {
    const { session, display, meshes, invalidate } = this.context;
    this.drawing?.dispose();
    this.scene = scene;
    this.displacement.set(new Map());
    this.rowByLink = new Map(scene.links.map((link, row) => [link.name, row]));
    this.drawing = new RobotDrawing(
      { links: scene.links, joints: [] },
      meshes,
      (link, url, error) => session.connection.send({ type: "mesh_status", display: display.id, link, url, error }),
      () => {
        this.isStyleStale = true;
        invalidate();
      },
    );
    this.root.add(this.drawing.root);
    this.sensors.setScene(scene);
    this.isStyleStale = true;
  }
}

function isLikeGround(box: Box3): boolean {
  const { x, y, z } = box.getSize(new Vector3());
  return z < GROUND_FLATNESS * Math.min(x, y);
}
