import { BoxGeometry, EdgesGeometry, Matrix4, Vector3, type Box3 } from "three";
import { CopyBatch } from "../objects/copy-batch";
import { createCube } from "../objects/geometries";
import { LabelBatch } from "../objects/label-batch";
import { WideLines } from "../objects/wide-lines";
import { ContentDrawing } from "./content-drawing";
import type { DrawingContext } from "./drawing";
import { colorOf, poseAt } from "./styles";

/** The x y z of both ends of the twelve edges of a unit cube. */
const EDGE_ENDPOINTS = new EdgesGeometry(new BoxGeometry(1, 1, 1)).getAttribute("position").array as Float32Array;
/** The minimum and maximum height of a line of text, m; between them it is a third of the box. */
const TEXT_HEIGHT_RANGE_M = [0.05, 0.5] as const;

/** The displays of vision_msgs_rviz_plugins: boxes or their edges only, in the colors of their classes. */
export class BoxesDrawing extends ContentDrawing<"solid_boxes"> {
  private readonly boxes = new CopyBatch(this.root, createCube());
  private readonly edges = new WideLines();
  private readonly labels = new LabelBatch();
  private texts: string[] = [];

  constructor(context: DrawingContext) {
    super(context, "solid_boxes");
    this.root.add(this.edges.root, this.labels.root);
  }

  dispose(): void {
    this.boxes.dispose();
    this.edges.dispose();
    this.labels.dispose();
  }

  protected override inspectContents(): object {
    return { boxes: this.latest?.sizes.length ? this.latest.sizes.length / 3 : 0, solid: this.boxes.size, texts: [...this.texts] };
  }

  protected expandBox(box: Box3): void {
    this.boxes.expandBox(box);
    this.edges.expandBox(box);
  }

  protected arrange(): void {
    const { rows } = this.context.display;
    const hasEdgesOnly = rows.bool(false, "Only Edge");
    const alpha = rows.number(1, "Alpha");
    // Boxes without classes arrive in white and get the display's color.
    const displayColor = rows.text("", "Color") === "" ? null : colorOf(rows, "#ffff00", "Color");
    const [posedContent] = this.listPosedContents();
    const content = posedContent?.content;
    const count = content ? content.sizes.length / 3 : 0;
    const segments: number[] = [];
    const colors: number[] = [];
    this.texts = [];
    const anchors: { position: Vector3; height: number }[] = [];
    this.boxes.begin(hasEdgesOnly ? 0 : count);
    for (let i = 0; i < count && content; i++) {
      const size = new Vector3().fromArray(content.sizes, 3 * i);
      const matrix = poseAt(content.poses, i, new Matrix4()).premultiply(posedContent.pose);
      const center = new Vector3().setFromMatrixPosition(matrix);
      const [r = 0, g = 0, b = 0] = content.colors.subarray(3 * i, 3 * i + 3);
      const color = displayColor ?? (r << 16) | (g << 8) | b;
      matrix.scale(size);
      if (hasEdgesOnly) {
        for (let offset = 0; offset < EDGE_ENDPOINTS.length; offset += 3) {
          segments.push(...new Vector3().fromArray(EDGE_ENDPOINTS, offset).applyMatrix4(matrix).toArray());
          colors.push((color >> 16) / 255, ((color >> 8) & 255) / 255, (color & 255) / 255, 1);
        }
      } else this.boxes.add(matrix, 0, alpha, color);
      const score = content.scores[i] ?? -1;
      if (score < 0 || !rows.bool(false, "Show Score")) continue;
      const height = Math.min(TEXT_HEIGHT_RANGE_M[1], Math.max(TEXT_HEIGHT_RANGE_M[0], size.z / 3));
      this.texts.push(`${content.names[i] ?? ""} ${score.toFixed(2)}`.trim());
      anchors.push({ position: center.setZ(center.z + 0.6 * size.z + height), height });
    }
    this.boxes.end();
    this.edges.setStyle(0xffffff, alpha, rows.number(0.05, "Line Width"));
    this.edges.setSegments(Float32Array.from(segments), Float32Array.from(colors));
    this.labels.begin(this.texts.join("").length);
    anchors.forEach(({ position, height }, i) => this.labels.add(this.texts[i] ?? "", position, height, 0, 1));
    this.labels.end();
  }
}
