import { Group, Matrix4, type Mesh, type Object3D } from "three";
import type { LinkScene } from "../../protocol";
import type { LinkOverride } from "../../state/comparison";
import type { MaterialPool } from "../materials";
import type { LodMeshes } from "../meshes/lod-meshes";
import { LinkTrail } from "./link-trail";
import type { MovingPiece } from "./moving-meshes";
import { ShapeDrawing, type ShapePiece, type InspectedShape } from "./shape-drawing";
import type { SolidKind, Solids } from "./solids";

/** The style of a link, from the display's properties and its own. */
export interface LinkStyle {
  isEnabled: boolean;
  showsVisual: boolean;
  showsCollision: boolean;
  /** The robot's alpha times the link's. */
  alpha: number;
  showsTrail: boolean;
  /** Whether to draw collisions over pale visuals, even if the display does not show them. */
  hasHighContrast: boolean;
  /** Replaces the colors of the description. */
  override: LinkOverride | null;
}

/** Draws a part of a robot at another pose than that of its description. */
export interface Displacement {
  /** Changes the pose of a link in the fixed frame. */
  readonly moveLink?: (name: string, matrix: Matrix4) => void;
  /** Moves a shape of a link: the one with this `index` among the shapes at `from` in the link. */
  readonly movedShape?: { readonly link: string; readonly kind: "visual" | "collision"; readonly index: number; readonly from: Matrix4; readonly to: Matrix4 };
}

/** In contrast mode: the factor for the visuals' alpha, and the color and alpha of collisions. */
const PALE_FACTOR = 0.3;
const COLLISION_OVERRIDE: LinkOverride = { color: [1, 0.55, 0.1] };
const COLLISION_ALPHA = 0.55;

const scratchMatrix = new Matrix4();

/** Computes the pose of a link in the fixed frame; returns false, and leaves `matrix` unchanged, if it is unknown. */
export type ReadLinkPose = (link: LinkScene, matrix: Matrix4) => boolean;

/** The drawing of a link: its visuals and collisions, in the link's frame. */
export class LinkDrawing {
  readonly root = new Group();
  readonly visuals: readonly ShapeDrawing[];
  readonly collisions: readonly ShapeDrawing[];
  private readonly visualGroup = new Group();
  private readonly collisionGroup = new Group();
  private trail: LinkTrail | null = null;
  private style: LinkStyle = { isEnabled: true, showsVisual: true, showsCollision: false, alpha: 1, showsTrail: false, hasHighContrast: false, override: null };
  private hasPose = false;
  private hasLostTransform = false;

  constructor(
    readonly link: LinkScene,
    private readonly pool: MaterialPool,
    /** The parent of objects in the fixed frame, such as the trail. */
    private readonly world: Object3D,
  ) {
    // Like RViz, paint collisions with the material of the link's first visual.
    const color = link.visuals[0]?.color ?? null;
    this.visuals = link.visuals.map((shape) => new ShapeDrawing(shape));
    this.collisions = link.collisions.map((shape) => new ShapeDrawing({ ...shape, color: shape.color ?? color }));
    for (const visual of this.visuals) this.visualGroup.add(visual.root);
    for (const collision of this.collisions) this.collisionGroup.add(collision.root);
    this.visualGroup.matrixAutoUpdate = this.collisionGroup.matrixAutoUpdate = false;
    this.root.matrixAutoUpdate = false;
    this.root.visible = false;
    this.root.add(this.visualGroup, this.collisionGroup);
  }

  /** Whether the link has visuals that are enabled. */
  get showsVisuals(): boolean {
    return this.visuals.length > 0 && this.visualGroup.visible;
  }

  /** The number of visuals drawn now. */
  get visualsDrawn(): number {
    if (!this.root.visible || !this.visualGroup.visible) return 0;
    return this.visuals.filter((visual) => visual.isDrawn).length;
  }

  /** The pose at which the link is drawn; null until it has a transform. */
  get pose(): Matrix4 | null {
    return this.hasPose ? this.root.matrix : null;
  }

  /** The meshes of the parts that are visible now. */
  get visibleMeshes(): Mesh[] {
    return this.shownShapes.flatMap((shape) => shape.meshes);
  }

  /** Counts the shapes that `addSolids` adds. */
  countSolids(counts: Map<SolidKind, number>): void {
    for (const { solid } of this.shownShapes) if (solid) counts.set(solid.kind, (counts.get(solid.kind) ?? 0) + 1);
  }

  /** Adds the shapes that are drawn in batches with those of other links. */
  addSolids(solids: Solids): void {
    for (const { solid } of this.shownShapes) {
      if (solid) solids.add(solid.kind, scratchMatrix.multiplyMatrices(this.root.matrix, solid.matrix), solid.color);
    }
  }

  /**
   * Adds the meshes that are drawn together with those of other links while the robot moves, see
   * `ShapeDrawing.addPieces`.
   */
  addPieces(lodMeshes: LodMeshes, meshes: Mesh[], pieces: MovingPiece[]): boolean {
    const linkPieces: ShapePiece[] = [];
    const results = this.shownShapes.map((shape) => shape.addPieces(lodMeshes, meshes, linkPieces));
    for (const { lodMesh, matrix, color } of linkPieces) {
      pieces.push({ lodMesh, matrix: new Matrix4().multiplyMatrices(this.root.matrix, matrix), color });
    }
    return results.every((isComplete) => isComplete);
  }

  setStyle(style: LinkStyle): void {
    this.style = style;
    this.visualGroup.visible = (style.showsVisual || style.hasHighContrast) && style.isEnabled;
    this.collisionGroup.visible = (style.showsCollision || style.hasHighContrast) && style.isEnabled;
    this.showTrail(style.showsTrail && style.isEnabled);
    this.paint();
  }

  paint(): void {
    const { hasHighContrast, override } = this.style;
    const alpha = override?.isOpaque === true ? Math.sqrt(this.style.alpha) : this.style.alpha;
    for (const visual of this.visuals) visual.paint(this.pool, hasHighContrast ? alpha * PALE_FACTOR : alpha, this.hasLostTransform, override);
    for (const collision of this.collisions) {
      if (hasHighContrast) collision.paint(this.pool, alpha * COLLISION_ALPHA, this.hasLostTransform, COLLISION_OVERRIDE);
      else collision.paint(this.pool, alpha, this.hasLostTransform, override);
    }
  }

  /** Moves the link to its pose. Like RViz, leaves a link without a transform in place, in white. */
  updatePose(readPose: ReadLinkPose, isCovered: boolean): void {
    const hasPose = readPose(this.link, this.root.matrix);
    this.hasPose ||= hasPose;
    this.root.visible = this.hasPose && !isCovered;
    this.root.matrixWorldNeedsUpdate = true;
    if (hasPose) this.trail?.follow(this.root.matrix);
    if (this.hasPose && hasPose === this.hasLostTransform) {
      this.hasLostTransform = !hasPose;
      this.paint();
    }
  }

  /** Draws one of its shapes at another pose; null restores all. */
  displaceShape(displaced: Displacement["movedShape"] | null): void {
    for (const shape of [...this.visuals, ...this.collisions]) shape.displace(null);
    const { style } = this;
    // Show a collision that is being moved even if collisions are hidden.
    this.collisionGroup.visible = (style.showsCollision || style.hasHighContrast || displaced?.kind === "collision") && style.isEnabled;
    if (!displaced) return;
    const shapes = displaced.kind === "visual" ? this.visuals : this.collisions;
    shapes.filter((shape) => shape.isAt(displaced.from))[displaced.index]?.displace(displaced.to);
  }

  /** Returns what is drawn, for tests. */
  inspect(): { visuals: InspectedShape[]; collisions: InspectedShape[]; trail: boolean } {
    const { visible } = this.root;
    return {
      visuals: visible && this.visualGroup.visible ? this.visuals.map((visual) => visual.inspect()) : [],
      collisions: visible && this.collisionGroup.visible ? this.collisions.map((collision) => collision.inspect()) : [],
      trail: this.trail !== null,
    };
  }

  dispose(): void {
    this.root.removeFromParent();
    this.showTrail(false);
    for (const shape of [...this.visuals, ...this.collisions]) shape.dispose();
  }

  private get shownShapes(): readonly ShapeDrawing[] {
    if (!this.root.visible) return [];
    const visuals = this.visualGroup.visible ? this.visuals : [];
    return this.collisionGroup.visible ? [...visuals, ...this.collisions] : visuals;
  }

  private showTrail(isShown: boolean): void {
    if (isShown === (this.trail !== null)) return;
    this.trail?.dispose();
    this.trail = isShown ? new LinkTrail(this.world) : null;
  }
}
