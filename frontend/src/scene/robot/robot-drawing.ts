import { Box3, Group, Vector3, type Camera, type Matrix4, type Mesh, type Object3D, type Raycaster } from "three";
import type { LinkScene, RobotScene } from "../../protocol";
import type { LinkOverride } from "../../state/comparison";
import type { PropertyRows } from "../../state/properties";
import type { DescriptionRow, Hit, SelectionBox } from "../picking";
import { describePose } from "../described-pose";
import type { Lighting } from "../light";
import { MaterialPool } from "../materials";
import type { MeshLibrary } from "../meshes/mesh-library";
import { MovingMeshes, type MovingView, type MovingPiece } from "./moving-meshes";
import { computeGroundHeight } from "./ground";
import { LinkDrawing, type Displacement, type ReadLinkPose } from "./link-drawing";
import { RobotExtras } from "./robot-extras";
import type { ShapeDrawing } from "./shape-drawing";
import { Solids, type SolidKind } from "./solids";

/** Called once for each mesh of each link; `error` is null if all of it is drawn. */
export type MeshReport = (link: string, url: string, error: string | null) => void;

type OverrideOf = (link: string) => LinkOverride | null;

/** The links and joints of a robot, or of all models of a world. */
type DrawnLinks = Pick<RobotScene, "links" | "joints">;

/** The drawing of a robot description, link by link. */
export class RobotDrawing {
  readonly root = new Group();
  /** Resolved once every mesh and texture has loaded or failed. */
  readonly settling: Promise<void>;
  private readonly pool = new MaterialPool();
  private readonly links: ReadonlyMap<string, LinkDrawing>;
  private readonly extras: RobotExtras;
  private readonly solids: Solids;
  private readonly movingMeshes: MovingMeshes;
  private readonly linkByMesh = new Map<number, string>();
  private loadingCount: number;

  constructor(private readonly scene: DrawnLinks, private readonly meshes: MeshLibrary, reportMesh: MeshReport, onChanged: () => void) {
    this.links = new Map(scene.links.map((link) => [link.name, new LinkDrawing(link, this.pool, this.root)]));
    for (const link of this.links.values()) this.root.add(link.root);
    this.extras = new RobotExtras(scene, this.root);
    this.solids = new Solids(this.root);
    this.movingMeshes = new MovingMeshes(this.root);
    const loads: Promise<void>[] = [];
    for (const link of this.links.values()) {
      for (const shape of [...link.visuals, ...link.collisions]) {
        const { url, texture, surface } = shape.shape;
        if (url === null && texture === null && surface === null) continue;
        loads.push(this.load(link, shape, reportMesh, onChanged));
      }
    }
    this.loadingCount = loads.length;
    this.settling = Promise.all(loads).then(() => undefined);
  }

  get isSettled(): boolean {
    return this.loadingCount === 0;
  }

  get visualsDrawn(): number {
    let count = 0;
    for (const link of this.links.values()) count += link.visualsDrawn;
    return count;
  }

  get hasPose(): boolean {
    const links = [...this.links.values()];
    const visibleLinks = links.filter((link) => link.showsVisuals);
    return (visibleLinks.length > 0 ? visibleLinks : links).some((link) => link.pose !== null);
  }

  get linkCount(): number {
    return this.links.size;
  }

  /** The number of links with a pose, and of meshes and textures still loading. */
  get progress(): { posed: number; loading: number } {
    return { posed: [...this.links.values()].filter((link) => link.pose !== null).length, loading: this.loadingCount };
  }

  /**
   * Returns the bounding box of the visible parts in the fixed frame, m; of the links' origins if nothing is visible.
   */
  computeBounds(): Box3 {
    const box = new Box3();
    for (const linkBox of this.boundsOfLinks().values()) box.union(linkBox);
    if (!box.isEmpty()) return box;
    for (const { pose } of this.links.values()) if (pose) box.expandByPoint(new Vector3().setFromMatrixPosition(pose));
    return box;
  }

  /**
   * Returns a box that contains all visible parts but may be larger, because it is computed without single vertices.
   */
  computeRoughBounds(): Box3 {
    const box = new Box3();
    this.root.updateWorldMatrix(true, true);
    for (const mesh of this.visibleMeshes) box.expandByObject(mesh);
    return box;
  }

  /** The meshes of the visible parts. */
  get visibleMeshes(): Mesh[] {
    return [...this.links.values()].flatMap((link) => link.visibleMeshes);
  }

  /** Returns the height of the ground below the robot in the fixed frame, m. */
  computeGround(): number {
    return computeGroundHeight(this.scene, this.boundsOfLinks());
  }

  /**
   * Returns the bounding boxes of the visible parts of each link in the fixed frame, m; empty for links without any.
   */
  boundsOfLinks(): Map<string, Box3> {
    this.root.updateWorldMatrix(true, true);
    const boxes = new Map<string, Box3>();
    for (const [name, link] of this.links) {
      const box = new Box3();
      for (const mesh of link.visibleMeshes) box.expandByObject(mesh, true);
      boxes.set(name, box);
    }
    return boxes;
  }

  /**
   * Applies the display's properties. `hasHighContrast` draws collisions over pale visuals; `overrideOf` returns the
   * colors that replace those of a link.
   */
  applyStyle(rows: PropertyRows, hasHighContrast: boolean, lighting: Lighting = "Camera", overrideOf: OverrideOf = () => null): void {
    this.pool.lighting = lighting;
    this.solids.isSoft = this.movingMeshes.isSoft = lighting === "Soft";
    this.pool.repaint(() => this.styleLinks(rows, hasHighContrast, overrideOf));
    this.extras.readProperties(rows);
  }

  /** Moves all links to their poses; `isCovered` returns whether another drawing shows a link already. */
  updatePoses(readPose: ReadLinkPose, isCovered: (link: LinkScene) => boolean = () => false): void {
    const counts = new Map<SolidKind, number>();
    for (const link of this.links.values()) {
      link.updatePose(readPose, isCovered(link.link));
      link.countSolids(counts);
    }
    this.solids.begin(counts);
    for (const link of this.links.values()) link.addSolids(this.solids);
    this.solids.end();
    this.extras.updatePoses((name) => this.links.get(name)?.pose ?? null);
  }

  displaceShape(displaced: Displacement["movedShape"] | null): void {
    for (const link of this.links.values()) link.displaceShape(displaced?.link === link.link.name ? displaced : null);
  }

  /** Chooses the detail of shapes for the camera of the next frame. */
  chooseDetail(camera: Camera): void {
    this.solids.chooseDetail(camera);
  }

  /**
   * Draws the meshes of a moving robot with fewer triangles where the difference is not visible; null restores them.
   */
  simplify(view: MovingView | null): void {
    this.movingMeshes.restoreMeshes();
    const { lodMeshes } = this.meshes;
    if (!view || !lodMeshes || this.pool.isLit) return;
    const [pieces, meshes]: [MovingPiece[], Mesh[]] = [[], []];
    const results = [...this.links.values()].map((link) => link.addPieces(lodMeshes, meshes, pieces));
    if (pieces.length > 0 && results.every((isComplete) => isComplete)) this.movingMeshes.replaceMeshes(pieces, meshes, view);
  }

  pick(ray: Raycaster): Hit | null {
    this.linkByMesh.clear();
    const targets = [...this.links.values()].flatMap((link) => {
      const meshes = link.visibleMeshes;
      for (const mesh of meshes) this.linkByMesh.set(mesh.id, link.link.name);
      return meshes;
    });
    const [nearest] = ray.intersectObjects(targets, false);
    const link = nearest && this.linkByMesh.get(nearest.object.id);
    return nearest && link !== undefined ? { key: link, distance: nearest.distance, point: nearest.point } : null;
  }

  pickBox(box: SelectionBox): string[] {
    const links = [...this.links.values()].filter((link) => link.visibleMeshes.some((mesh) => box.hasObject(mesh)));
    return links.map((link) => link.link.name);
  }

  /** Returns a link as RViz's Selection panel shows it. */
  describe(name: string): DescriptionRow | null {
    const link = this.links.get(name);
    return link ? { name: `Link ${name}`, children: describePose(link.root.matrix) } : null;
  }

  /** Returns the pose of a link; null until it is known. */
  poseOf(name: string): Matrix4 | null {
    return this.links.get(name)?.pose ?? null;
  }

  /** Returns the origin of a link; null until it is known. */
  positionOf(name: string): Vector3 | null {
    const pose = this.poseOf(name);
    return pose ? new Vector3().setFromMatrixPosition(pose) : null;
  }

  /** Returns what is drawn, for tests: the shapes of each link, and the counts of other marks. */
  inspect(): object {
    const links = [...this.links.values()].map((link) => [link.link.name, link.inspect()] as const);
    const { size: drawnTogether, smallSphereCount } = this.solids;
    return { ...this.extras.counts, drawnTogether, smallSpheres: smallSphereCount, moving: this.movingMeshes.drawnCounts, links: Object.fromEntries(links) };
  }

  objectsOf(link: string): readonly Object3D[] {
    return this.links.get(link)?.visibleMeshes ?? [];
  }

  dispose(): void {
    for (const link of this.links.values()) link.dispose();
    this.extras.dispose();
    this.solids.dispose();
    this.movingMeshes.dispose();
    this.root.removeFromParent();
    this.pool.dispose();
  }

  private styleLinks(rows: PropertyRows, hasHighContrast: boolean, overrideOf: OverrideOf): void {
    const rowsByLink = new Map(rows.find("Links")?.children.map((row) => [row.name, row]));
    const alpha = rows.number(1, "Alpha");
    const showsVisual = rows.bool(true, "Visual Enabled");
    const showsCollision = rows.bool(false, "Collision Enabled");
    for (const [name, link] of this.links) {
      const row = rowsByLink.get(name);
      const valueOf = (title: string): unknown => row?.children.find((candidate) => candidate.name === title)?.value;
      const linkAlpha = valueOf("Alpha");
      link.setStyle({
        showsVisual,
        showsCollision,
        isEnabled: row?.value !== false,
        alpha: alpha * (typeof linkAlpha === "number" ? linkAlpha : 1),
        showsTrail: valueOf("Show Trail") === true,
        hasHighContrast,
        override: overrideOf(name),
      });
    }
  }

  private async load(
    link: LinkDrawing,
    shape: ShapeDrawing,
    reportMesh: MeshReport,
    onChanged: () => void,
  ): Promise<void> {
    const { url } = shape.shape;
    let error: string | null = null;
    try {
      error = await shape.load(this.meshes);
      link.paint();
    } catch (reason) {
      error = reason instanceof Error ? reason.message : String(reason);
    }
    this.loadingCount -= 1;
    if (url !== null) reportMesh(link.link.name, url, error);
    onChanged();
  }
}
