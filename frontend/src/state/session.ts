import type { Connection } from "../connection/connection";
import type { DiagnosticItem, Hello, LinkStory, PropertyValue, RobotScene, ServerMessage } from "../protocol.gen";
import { DisplaysState } from "./displays";
import { FrameStore } from "./frames";
import { JointsState } from "./joints";
import { SelectionState } from "./selection";
import { Signal } from "./signal";
import { ViewState } from "./view";

const VIEW_CHANGED_INTERVAL_MS = 250;

/** Everything the page knows, kept current from the server's messages. Panels and drawings listen to its parts. */
export class Session {
  readonly frames = new FrameStore();
  readonly displays = new DisplaysState();
  readonly joints = new JointsState();
  readonly selection = new SelectionState();
  readonly view = new ViewState(this.frames);
  readonly robotChanged = new Signal<RobotScene>();
  readonly diagnosticsChanged = new Signal();
  /** Answers `ask_story`. */
  readonly storyTold = new Signal<LinkStory>();
  readonly greeted = new Signal<Hello>();
  /** The newest description of each RobotModel display, by display id. */
  readonly robots = new Map<string, RobotScene>();
  diagnostics: readonly DiagnosticItem[] = [];
  private viewTimer = 0;
  private viewFromServer = false;

  constructor(readonly connection: Connection) {
    connection.message.on((message) => this.receive(message));
    connection.transforms.on((transforms) => this.frames.setTransforms(transforms));
    this.view.changed.on(() => this.announceView());
  }

  /** The user edits a property: shown at once, and told to the server. */
  setProperty(id: string, value: PropertyValue): void {
    this.displays.setValue(id, value, null);
    this.connection.send({ type: "set_property", id, value });
  }

  /** The first robot that has links, if any. */
  get robot(): RobotScene | null {
    for (const display of this.displays.displays) {
      const robot = this.robots.get(display.id);
      if (robot && robot.links.length > 0) return robot;
    }
    return null;
  }

  private receive(message: ServerMessage): void {
    switch (message.type) {
      case "hello":
        this.greeted.emit(message);
        break;
      case "tree":
        this.displays.setTree(message);
        for (const id of this.robots.keys()) if (!this.displays.find(id)) this.robots.delete(id);
        break;
      case "display_properties":
        this.displays.setRows(message.display, message.properties);
        break;
      case "property_changed":
        this.displays.setValue(message.id, message.value, message.options);
        break;
      case "display_status":
        this.displays.setStatus(message.display, message.level, message.status);
        break;
      case "robot_scene":
        this.robots.set(message.display, message);
        this.robotChanged.emit(message);
        this.selection.robotChanged(message);
        break;
      case "frame_table":
        this.frames.setTable(message);
        break;
      case "view_state":
        this.viewFromServer = true;
        this.view.configure(message.view);
        this.viewFromServer = false;
        break;
      case "joints":
        this.joints.setControls(message.controls);
        break;
      case "joint_positions":
        this.joints.setPositions(message.positions);
        break;
      case "diagnostics":
        this.diagnostics = message.items;
        this.diagnosticsChanged.emit();
        break;
      case "link_story":
        this.storyTold.emit(message);
        break;
    }
  }

  private announceView(): void {
    if (this.viewTimer !== 0 || this.viewFromServer) return;
    this.viewTimer = window.setTimeout(() => {
      this.viewTimer = 0;
      this.connection.send({ type: "view_changed", view: { ...this.view.current } });
    }, VIEW_CHANGED_INTERVAL_MS);
  }
}
