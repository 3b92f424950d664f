import { Box3, Group, Matrix4 } from "three";
import type { DisplayData } from "../../connection/data";
import type { DataContent } from "../../protocol";
import { readDataPose } from "../pose";
import type { Drawing, DrawingContext } from "./drawing";

type Kind = DataContent["kind"];
type ContentOf<K extends Kind> = Extract<DataContent, { kind: K }>;

/** A content with its key, its frame, and the pose of the frame in the fixed frame. */
export interface PosedContent<C> {
  key: string;
  frame: string;
  content: C;
  pose: Matrix4;
}

/**
 * The base class of displays that draw contents of one kind, each in its frame. A subclass updates its objects in
 * `arrange`, which is called before a frame if a content, a property or a pose has changed.
 */
export abstract class ContentDrawing<K extends Kind> implements Drawing {
  readonly root = new Group();
  private readonly contents = new Map<string, DisplayData>();
  private isStale = true;

  constructor(
    protected readonly context: DrawingContext,
    private readonly kind: K,
  ) {}

  onDataChanged(data: DisplayData): void {
    if (data.content.kind !== this.kind) return;
    // Insert again so that the newest content is the last.
    this.contents.delete(data.key);
    this.contents.set(data.key, data);
    this.isStale = true;
  }

  onDataRemoved(key: string | null): void {
    if (key === null) this.contents.clear();
    else this.contents.delete(key);
    this.isStale = true;
  }

  onPropertiesChanged(): void {
    this.isStale = true;
  }

  update(): void {
    const hasMovingFrame = [...this.contents.values()].some((data) => data.pose === null && data.frame !== "");
    if (!this.isStale && !hasMovingFrame) return;
    this.isStale = false;
    this.arrange();
  }

  /** Returns the counts and bounds of the drawn objects; bounds are in the fixed frame, null if nothing is drawn. */
  inspect(): object {
    const box = new Box3();
    this.expandBox(box);
    const bounds = box.isEmpty() ? null : { min: box.min.toArray(), max: box.max.toArray() };
    return { contents: this.contents.size, bounds, ...this.inspectContents() };
  }

  abstract dispose(): void;
  protected abstract arrange(): void;
  protected abstract expandBox(box: Box3): void;

  /** Returns further results for `inspect`. */
  protected inspectContents(): object {
    return {};
  }

  /** The newest content. */
  protected get latest(): ContentOf<K> | null {
    const newestContent = [...this.contents.values()].at(-1);
    return newestContent ? (newestContent.content as ContentOf<K>) : null;
  }

  /** Returns the contents whose frame has a pose, with new matrices. */
  protected listPosedContents(): PosedContent<ContentOf<K>>[] {
    const result: PosedContent<ContentOf<K>>[] = [];
    for (const data of this.contents.values()) {
      const pose = new Matrix4();
      if (!readDataPose(this.context.session.frames, data, pose)) continue;
      result.push({ key: data.key, frame: data.frame, content: data.content as ContentOf<K>, pose });
    }
    return result;
  }
}
