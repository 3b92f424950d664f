import { Group } from "three";
import type { DisplayData } from "../../connection/data";
import type { ImageFrame } from "../../protocol";
import { strings } from "../../strings";
import { OwnPanel } from "../images/own-panel";
import { ImageCanvas } from "../images/image-canvas";
import type { Drawing, DrawingContext } from "./drawing";

/** rviz_default_plugins/Image: a panel of its own with the image, and nothing in the scene. */
export class ImageDrawing implements Drawing {
  readonly root = new Group();
  readonly isElsewhere = true;
  private readonly image: ImageCanvas;
  protected readonly panel: OwnPanel;
  /** The stamp of the image on the canvas, s. */
  protected imageStamp = 0;
  private frame: ImageFrame | null = null;
  private readonly resizeObserver = new ResizeObserver(() => {
    this.sendSize();
    this.onPainted();
  });
  private readonly unsubscribe: (() => void)[];
  private state: "none" | "shown" | "unreadable" = "none";

  constructor(protected readonly context: DrawingContext) {
    this.image = new ImageCanvas(context.showWithFrame);
    this.panel = new OwnPanel(context, "image", this.image.canvas);
    this.showState();
    this.panel.update();
    this.resizeObserver.observe(this.panel.element);
    const { connection, displays } = context.session;
    this.unsubscribe = [connection.on("tree", () => this.sendSize()), displays.statusChanged.on(() => this.showState())];
  }

  onPropertiesChanged(): void {
    this.panel.update();
  }

  onDataChanged({ content, stamp }: DisplayData): void {
    if (content.kind !== "image_frame") return;
    this.frame = content;
    this.image.show(content, (isReadable) => {
      this.state = isReadable ? "shown" : "unreadable";
      this.showState();
      if (!isReadable) return;
      this.imageStamp = stamp;
      this.onPainted();
    });
  }

  onDataRemoved(key: string | null): void {
    if (key) return; // the image has none
    this.frame = null;
    this.image.clear();
    this.state = "none";
    this.showState();
  }

  update(): void {
    // The display draws nothing into the scene.
  }

  inspect(): object {
    const { canvas } = this.image;
    const [x, y] = [Math.floor(canvas.width / 2), Math.floor(canvas.height / 2)];
    return {
      images: this.image.count,
      ...this.size,
      middle: this.image.colorAt(x, y),
      corner: this.image.colorAt(0, 0),
    };
  }

  /** Called when a new image is on the canvas, or the panel was resized. */
  protected onPainted(): void {
    // An image alone has no overlay.
  }

  /** The size of the message's image in pixels; 0 while there is none. */
  protected get size(): { width: number; height: number } {
    const { canvas } = this.image;
    return { width: this.frame?.width || canvas.width, height: this.frame?.height || canvas.height };
  }

  dispose(): void {
    this.resizeObserver.disconnect();
    for (const stop of this.unsubscribe) stop();
    this.panel.close();
  }

  /** Shows why there is no image, usually with a text of the display's status. */
  private showState(): void {
    const { none, unreadable } = strings.images;
    const cause = this.context.display.problems[0]?.text;
    if (this.state === "shown") this.panel.showText("");
    else this.panel.showText(this.state === "unreadable" ? unreadable : none, cause);
  }

  /** Sends the panel's size to the server, which need not send more pixels than that. */
  private sendSize(): void {
    const { display, session } = this.context;
    const toPixels = (cssPixels: number): number => Math.ceil(cssPixels * window.devicePixelRatio);
    const { clientWidth, clientHeight } = this.panel.element;
    session.connection.send({
      type: "image_size",
      display: display.id,
      width: toPixels(clientWidth),
      height: toPixels(clientHeight),
    });
  }
}
