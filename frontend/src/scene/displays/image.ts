import { Group } from "three";
import type { DisplayData } from "../../connection/data";
import type { ImageFrame } from "../../protocol";
import { strings } from "../../strings";
import { OwnPanel } from "../pictures/own-panel";
import { PictureCanvas } from "../pictures/picture-canvas";
import type { Drawing, DrawingContext } from "./drawing";

/** rviz_default_plugins/Image: nothing in the scene, a panel of its own with the image. */
export class ImageDrawing implements Drawing {
  readonly root = new Group();
  readonly isElsewhere = true;
  private readonly picture: PictureCanvas;
  protected readonly panel: OwnPanel;
  /** When the image on the canvas was taken, s. */
  protected imageStamp = 0;
  private frame: ImageFrame | null = null;
  private readonly resizing = new ResizeObserver(() => {
    this.tellSize();
    this.painted();
  });
  private readonly stopListening: () => void;

  constructor(protected readonly context: DrawingContext) {
    this.picture = new PictureCanvas(context.beside);
    this.panel = new OwnPanel(context, "image", this.picture.canvas);
    this.panel.say(strings.pictures.none);
    this.panel.match();
    this.resizing.observe(this.panel.element);
    this.stopListening = context.session.connection.on("tree", () => this.tellSize());
  }

  propertiesChanged(): void {
    this.panel.match();
  }

  dataChanged({ content, stamp }: DisplayData): void {
    if (content.kind !== "image_frame") return;
    this.frame = content;
    this.picture.take(content, (shown) => {
      this.panel.say(shown ? "" : strings.pictures.unreadable);
      if (!shown) return;
      this.imageStamp = stamp;
      this.painted();
    });
  }

  dataForgotten(key: string | null): void {
    if (key) return; // the image has none
    this.frame = null;
    this.picture.clear();
    this.panel.say(strings.pictures.none);
  }

  update(): void {
    // It has no place in the scene.
  }

  inspect(): object {
    const { canvas } = this.picture;
    const [x, y] = [Math.floor(canvas.width / 2), Math.floor(canvas.height / 2)];
    return {
      images: this.picture.count,
      ...this.size,
      middle: this.picture.colorAt(x, y),
      corner: this.picture.colorAt(0, 0),
    };
  }

  /** The image has come onto the canvas, or the panel has another size. */
  protected painted(): void {
    // Nothing is drawn over it.
  }

  /** Pixels of the message's image, 0 while there is none. */
  protected get size(): { width: number; height: number } {
    const { canvas } = this.picture;
    return { width: this.frame?.width || canvas.width, height: this.frame?.height || canvas.height };
  }

  dispose(): void {
    this.resizing.disconnect();
    this.stopListening();
    this.panel.close();
  }

  /** More pixels than the panel has need not come. */
  private tellSize(): void {
    const { display, session } = this.context;
    const pixels = (points: number): number => Math.ceil(points * window.devicePixelRatio);
    const { clientWidth, clientHeight } = this.panel.element;
    session.connection.send({
      type: "picture_size",
      display: display.id,
      width: pixels(clientWidth),
      height: pixels(clientHeight),
    });
  }
}
