import { Group, Matrix4, type Mesh, type Object3D } from "three";
import type { LinkScene } from "../../protocol";
import type { Instead } from "../../state/comparison";
import type { MaterialPool } from "../materials";
import type { StandIns } from "../meshes/stand-ins";
import { LinkTrail } from "./link-trail";
import type { MovingPiece } from "./moving-meshes";
import { ShapeDrawing, type ShapePiece, type ShapeTold } from "./shape-drawing";
import type { SolidKind, Solids } from "./solids";

/** The style of a link: the display's properties and the link's own, together. */
export interface LinkStyle {
  enabled: boolean;
  visual: boolean;
  collision: boolean;
  /** Robot's times link's. */
  alpha: number;
  trail: boolean;
  /** Collisions over pale visuals, whether the display draws them or not. */
  contrast: boolean;
  /** Takes the place of the colours of the description. */
  instead: Instead | null;
}

/** A part of a robot that is drawn elsewhere than its description has it. */
export interface Displacement {
  /** Changes where a link is in the fixed frame. */
  readonly link?: (name: string, matrix: Matrix4) => void;
  /** A shape of a link: of the shapes at `from` in it, the one after so many others. */
  readonly shape?: { readonly link: string; readonly kind: "visual" | "collision"; readonly among: number; readonly from: Matrix4; readonly to: Matrix4 };
}

/** In contrast: what is left of the visuals' alpha, and the collisions' colour and alpha. */
const PALE = 0.3;
const COLLISION: Instead = { color: [1, 0.55, 0.1] };
const COLLISION_ALPHA = 0.55;

const scratch = new Matrix4();

/** Writes where a link is in the fixed frame into `matrix`; false, and nothing written, where that is not known. */
export type FindLink = (link: LinkScene, matrix: Matrix4) => boolean;

/** One link: its visuals and collisions in the frame of its name. */
export class LinkDrawing {
  readonly root = new Group();
  readonly visuals: readonly ShapeDrawing[];
  readonly collisions: readonly ShapeDrawing[];
  private readonly visualGroup = new Group();
  private readonly collisionGroup = new Group();
  private trail: LinkTrail | null = null;
  private style: LinkStyle = { enabled: true, visual: true, collision: false, alpha: 1, trail: false, contrast: false, instead: null };
  private posed = false;
  private lost = false;

  constructor(
    readonly link: LinkScene,
    private readonly pool: MaterialPool,
    /** Where things in the fixed frame go, such as the trail. */
    private readonly world: Object3D,
  ) {
    // RViz paints collisions with the material of the link's first visual.
    const color = link.visuals[0]?.color ?? null;
    this.visuals = link.visuals.map((shape) => new ShapeDrawing(shape));
    this.collisions = link.collisions.map((shape) => new ShapeDrawing({ ...shape, color: shape.color ?? color }));
    for (const each of this.visuals) this.visualGroup.add(each.root);
    for (const each of this.collisions) this.collisionGroup.add(each.root);
    this.visualGroup.matrixAutoUpdate = this.collisionGroup.matrixAutoUpdate = false;
    this.root.matrixAutoUpdate = false;
    this.root.visible = false;
    this.root.add(this.visualGroup, this.collisionGroup);
  }

  /** Whether it has visuals that are to be drawn. */
  get showsVisuals(): boolean {
    return this.visuals.length > 0 && this.visualGroup.visible;
  }

  /** Shapes drawn now. */
  get visualsDrawn(): number {
    if (!this.root.visible || !this.visualGroup.visible) return 0;
    return this.visuals.filter((each) => each.drawn).length;
  }

  /** The pose at which it is drawn; null before it had a transform. */
  get pose(): Matrix4 | null {
    return this.posed ? this.root.matrix : null;
  }

  /** The meshes of the parts that are visible now. */
  get visibleMeshes(): Mesh[] {
    return this.shown.flatMap((each) => each.meshes);
  }

  /** Counts what `addSolids` adds. */
  countSolids(counts: Map<SolidKind, number>): void {
    for (const { solid } of this.shown) if (solid) counts.set(solid.kind, (counts.get(solid.kind) ?? 0) + 1);
  }

  /** Adds what is drawn together with the shapes of other links. */
  addSolids(solids: Solids): void {
    for (const { solid } of this.shown) {
      if (solid) solids.add(solid.kind, scratch.multiplyMatrices(this.root.matrix, solid.matrix), solid.color);
    }
  }

  /** Adds what is drawn together with meshes of other links while the robot moves, see `ShapeDrawing.addPieces`. */
  addPieces(standIns: StandIns, meshes: Mesh[], pieces: MovingPiece[]): boolean {
    const own: ShapePiece[] = [];
    const found = this.shown.map((shape) => shape.addPieces(standIns, meshes, own));
    for (const { standIn, matrix, color } of own) {
      pieces.push({ standIn, matrix: new Matrix4().multiplyMatrices(this.root.matrix, matrix), color });
    }
    return found.every((complete) => complete);
  }

  setStyle(style: LinkStyle): void {
    this.style = style;
    this.visualGroup.visible = (style.visual || style.contrast) && style.enabled;
    this.collisionGroup.visible = (style.collision || style.contrast) && style.enabled;
    this.showTrail(style.trail && style.enabled);
    this.paint();
  }

  paint(): void {
    const { contrast, instead } = this.style;
    const alpha = instead?.firm === true ? Math.sqrt(this.style.alpha) : this.style.alpha;
    for (const each of this.visuals) each.paint(this.pool, contrast ? alpha * PALE : alpha, this.lost, instead);
    for (const each of this.collisions) {
      if (contrast) each.paint(this.pool, alpha * COLLISION_ALPHA, this.lost, COLLISION);
      else each.paint(this.pool, alpha, this.lost, instead);
    }
  }

  /** Moves to where it is. Without a transform RViz leaves a link where it was, in white. */
  place(find: FindLink, isCovered: boolean): void {
    const found = find(this.link, this.root.matrix);
    this.posed ||= found;
    this.root.visible = this.posed && !isCovered;
    this.root.matrixWorldNeedsUpdate = true;
    if (found) this.trail?.follow(this.root.matrix);
    if (this.posed && found === this.lost) {
      this.lost = !found;
      this.paint();
    }
  }

  /** Draws one of its shapes elsewhere; null for none. */
  displaceShape(displaced: Displacement["shape"] | null): void {
    for (const each of [...this.visuals, ...this.collisions]) each.displace(null);
    const { style } = this;
    // A collision that is moved is seen, whether the others are or not.
    this.collisionGroup.visible = (style.collision || style.contrast || displaced?.kind === "collision") && style.enabled;
    if (!displaced) return;
    const shapes = displaced.kind === "visual" ? this.visuals : this.collisions;
    shapes.filter((each) => each.isAt(displaced.from))[displaced.among]?.displace(displaced.to);
  }

  /** What is drawn, for tests. */
  tell(): { visuals: ShapeTold[]; collisions: ShapeTold[]; trail: boolean } {
    const { visible } = this.root;
    return {
      visuals: visible && this.visualGroup.visible ? this.visuals.map((each) => each.tell()) : [],
      collisions: visible && this.collisionGroup.visible ? this.collisions.map((each) => each.tell()) : [],
      trail: this.trail !== null,
    };
  }

  dispose(): void {
    this.root.removeFromParent();
    this.showTrail(false);
    for (const each of [...this.visuals, ...this.collisions]) each.dispose();
  }

  private get shown(): readonly ShapeDrawing[] {
    if (!this.root.visible) return [];
    const visuals = this.visualGroup.visible ? this.visuals : [];
    return this.collisionGroup.visible ? [...visuals, ...this.collisions] : visuals;
  }

  private showTrail(show: boolean): void {
    if (show === (this.trail !== null)) return;
    this.trail?.dispose();
    this.trail = show ? new LinkTrail(this.world) : null;
  }
}
