import { h } from "../../dom";
import type { TeleopState } from "../../state/monitor/teleop";
import type { TurtlesimState } from "../../state/turtlesim";
import { strings } from "../../strings";
import { onVisibilityChange } from "../../widgets/visibility";
import type { Panel } from "../panel";

/** The window of turtlesim_node. Its code is loaded when the panel is first shown. */
export class TurtlesimPanel implements Panel {
  readonly id = "turtlesim";
  readonly icon = "turtle";
  readonly element: HTMLElement;
  private readonly notice = h("p", { class: "empty" }, strings.turtlesim.none);
  private loading: Promise<void> | null = null;

  constructor(
    private readonly state: TurtlesimState,
    private readonly teleop: TeleopState,
    private readonly openTeleop: () => void,
  ) {
    this.element = h("div", { class: "panel turtlesim-panel" }, this.notice);
    onVisibilityChange(this.element, (isVisible) => {
      if (!isVisible) state.watch(false);
      else void this.show();
    });
    state.simulatorsChanged.on(() => (this.notice.hidden = state.simulators.length > 0));
  }

  /** Watches the turtles once there is something to draw them. */
  private async show(): Promise<void> {
    await (this.loading ??= this.load());
    this.state.watch(this.element.isConnected);
  }

  private async load(): Promise<void> {
    const { TurtleDeck } = await import("./turtle-deck");
    this.element.append(new TurtleDeck(this.state, (topic) => this.drive(topic)).element);
  }

  /** Opens the Teleop panel for a turtle, with the speeds of turtle_teleop_key. */
  private drive(topic: string): void {
    this.teleop.configure({ topic, kind: "Twist", linear: 2, angular: 2 });
    this.openTeleop();
  }
}
