import { Box3, Group, Matrix4, Vector3, type Mesh, type Object3D, type Raycaster } from "three";
import type { LinkScene, RobotScene } from "../../protocol";
import { readFramePose } from "../pose";
import type { MovingView } from "../robot/moving-meshes";
import type { Displacement } from "../robot/link-drawing";
import { RobotDrawing } from "../robot/robot-drawing";
import type { Lighting } from "../light";
import { setShadowed } from "../studio-light";
import type { DescriptionRow, Hit, SelectionBox } from "../picking";
import type { Drawing, DrawingContext } from "./drawing";

/** A new robot replaces the old one once its meshes are loaded, or after this time without them. */
const MAX_SWAP_DELAY_MS = 300;
/** Links closer than this count as coincident: m, and components of quaternions. */
const COINCIDENCE_TOLERANCE = 1e-4;

/** rviz_default_plugins/RobotModel */
export class RobotModelDrawing implements Drawing {
  readonly root = new Group();
  private drawing: RobotDrawing | null = null;
  private nextDrawing: RobotDrawing | null = null;
  private drawingCount = 0;
  private lighting: Lighting = "Camera";
  private isStyleStale = true;
  private hasHighContrast: boolean;
  private displacement: Displacement | null = null;
  private readonly unsubscribe: readonly (() => void)[];

  constructor(private readonly context: DrawingContext) {
    const { session, display } = context;
    this.root.matrixAutoUpdate = false;
    const setRobot = (robot: RobotScene | undefined): void => {
      if (robot?.display === display.id) this.setRobot(robot);
    };
    this.hasHighContrast = session.inspect.current.contrast;
    this.unsubscribe = [
      session.robotChanged.on(setRobot),
      session.inspect.changed.on(() => this.onInspectChanged()),
      session.comparison.changed.on(() => this.onComparisonChanged()),
    ];
    setRobot(session.robots.get(display.id));
  }

  /** The number of visuals drawn now. */
  get visualsDrawn(): number {
    return this.root.visible ? (this.drawing?.visualsDrawn ?? 0) : 0;
  }

  /** Whether the robot has a pose: any link with visuals, or any link if no link has visuals. */
  get hasPose(): boolean {
    return this.drawing?.hasPose ?? false;
  }

  /** The number of links with a pose. */
  get linkCount(): number {
    return this.drawing?.linkCount ?? 0;
  }

  /** A key of the visible parts of the robot; empty while no robot or no transform is known. */
  get visibleKey(): string {
    const { posed, loading } = this.drawing?.progress ?? { posed: 0, loading: 0 };
    const isPlain = this.visualsDrawn === 0 && loading > 0;
    return posed === 0 || isPlain ? "" : [this.drawingCount, posed, loading].join();
  }

  /**
   * Returns the bounding box of the visible parts in the fixed frame, m; of the links' origins if nothing is visible.
   */
  computeBounds(): Box3 {
    return this.drawing?.computeBounds() ?? new Box3();
  }

  /** Returns the height of the ground below the robot in the fixed frame, m. */
  computeGround(): number {
    return this.drawing?.computeGround() ?? 0;
  }

  computeRoughBounds(): Box3 {
    return this.drawing?.computeRoughBounds() ?? new Box3();
  }

  /** The visible meshes. */
  get visibleMeshes(): Mesh[] {
    return this.root.visible ? (this.drawing?.visibleMeshes ?? []) : [];
  }

  /** The lighting of the robot; Studio has shadows. */
  set light(lighting: Lighting) {
    this.isStyleStale ||= lighting !== this.lighting;
    this.lighting = lighting;
  }

  /** Draws a part at another pose than that of the description; null restores it. */
  displace(displacement: Displacement | null): void {
    this.displacement = displacement;
    this.drawing?.displaceShape(displacement?.movedShape ?? null);
    this.context.invalidate();
  }

  onPropertiesChanged(): void {
    this.isStyleStale = true;
  }

  update(): void {
    if (this.isStyleStale && this.drawing) {
      const { display, session } = this.context;
      this.drawing.applyStyle(display.rows, this.hasHighContrast, this.lighting, (link) => session.comparison.overrideOf(display.id, link));
      setShadowed(this.drawing.root, this.lighting === "Studio" && !session.comparison.isOld(display.id));
    }
    this.isStyleStale = false;
    const { frames } = this.context.session;
    const computePose = (link: LinkScene, matrix: Matrix4): boolean => {
      const hasPose = readFramePose(frames, frames.rowOf(link.frame), matrix);
      if (hasPose) this.displacement?.moveLink?.(link.name, matrix);
      return hasPose;
    };
    this.drawing?.updatePoses(computePose, this.createDuplicateFilter());
    this.drawing?.chooseDetail(this.context.getCamera());
  }

  simplify(view: MovingView | null): void {
    this.drawing?.simplify(view);
  }

  isSettled(): boolean {
    return this.nextDrawing === null && (this.drawing?.isSettled ?? true);
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

  inspect(): object {
    return this.drawing?.inspect() ?? {};
  }

  /** Returns the origin of a link's frame, for links without visuals. */
  positionOf(name: string): Vector3 | null {
    const { session, display } = this.context;
    const link = session.robots.get(display.id)?.links.find((scene) => scene.name === name);
    const pose = new Matrix4();
    if (!link || !readFramePose(session.frames, session.frames.rowOf(link.frame), pose)) return null;
    return new Vector3().setFromMatrixPosition(pose);
  }

  objectsOf(link: string): readonly Object3D[] {
    return this.drawing?.objectsOf(link) ?? [];
  }

  dispose(): void {
    for (const stop of this.unsubscribe) stop();
    this.nextDrawing?.dispose();
    this.drawing?.dispose();
  }

  /**
   * Returns a predicate for the links of an old description that are not drawn, because they look the same in the new
   * one and have the same pose.
   */
  private createDuplicateFilter(): ((link: LinkScene) => boolean) | undefined {
    const { display, session } = this.context;
    const { comparison, displays, frames, robots } = session;
    const newDisplay = comparison.isOld(display.id) ? (comparison.compared?.new.display ?? "") : "";
    if (displays.find(newDisplay)?.isEnabled !== true) return undefined;
    const frameByLink = new Map(robots.get(newDisplay)?.links.map(({ name, frame }) => [name, frame]));
    return ({ name, frame }) => {
      const twin = comparison.twinOf(display.id, name);
      return twin !== undefined && frames.computeDifference(frame, frameByLink.get(twin) ?? "") < COINCIDENCE_TOLERANCE;
    };
  }

  private onComparisonChanged(): void {
    this.isStyleStale = true;
    this.context.invalidate();
  }

  private onInspectChanged(): void {
    const { contrast: hasHighContrast } = this.context.session.inspect.current;
    if (hasHighContrast === this.hasHighContrast) return;
    this.hasHighContrast = hasHighContrast;
    this.isStyleStale = true;
    this.context.invalidate();
  }

  private setRobot(scene: RobotScene): void {
    const { session, display, meshes, invalidate } = this.context;
    this.nextDrawing?.dispose();
    const robot = new RobotDrawing(
      scene,
      meshes,
      (link, url, error) => {
        session.connection.send({ type: "mesh_status", display: display.id, link, url, error });
      },
      () => {
        this.isStyleStale = true;
        invalidate();
      },
    );
    this.nextDrawing = robot;
    if (robot.isSettled || this.drawing === null) {
      this.swapIn(robot);
      return;
    }
    const timeout = new Promise((resolve) => setTimeout(resolve, MAX_SWAP_DELAY_MS));
    void Promise.race([robot.settling, timeout]).then(() => {
      if (this.nextDrawing === robot) this.swapIn(robot);
    });
  }

  private swapIn(robot: RobotDrawing): void {
    this.drawing?.dispose();
    this.drawing = robot;
    this.drawingCount += 1;
    this.nextDrawing = null;
    this.root.add(robot.root);
    this.isStyleStale = true;
    this.update();
    this.context.invalidate();
  }
}
