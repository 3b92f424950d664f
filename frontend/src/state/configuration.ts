import type { Connection } from "../connection/connection";
import type {
  Configuration,
  ConfigurationRefused,
  ConfigurationText,
  DisplayChoices,
  Folder,
} from "../protocol";
import { Signal } from "../signal";

/** The configuration file on the server: displays that can be added, undo and redo, and commands. */
export class ConfigurationState {
  /** The path, unsaved changes, undo or redo changed. */
  readonly changed = new Signal();
  readonly saved = new Signal<string>();
  readonly refused = new Signal<ConfigurationRefused>();
  readonly texts = new Signal<ConfigurationText>();
  readonly folders = new Signal<Folder>();
  readonly choicesArrived = new Signal<DisplayChoices>();
  /** The displays that can be added, from the server's last answer. */
  choices: DisplayChoices | null = null;
  current: Configuration = {
    type: "configuration",
    path: null,
    opened: 0,
    unsaved: false,
    undo: null,
    redo: null,
    is_own: false,
    recent: [],
  };

  constructor(private readonly connection: Connection) {
    connection.on("configuration", (message) => {
      this.current = message;
      this.changed.emit();
    });
    connection.on("configuration_saved", ({ path }) => this.saved.emit(path));
    connection.on("configuration_refused", (message) => this.refused.emit(message));
    connection.on("configuration_text", (message) => this.texts.emit(message));
    connection.on("folder", (message) => this.folders.emit(message));
    connection.on("display_choices", (message) => {
      this.choices = message;
      this.choicesArrived.emit(message);
    });
  }

  /** The name of the file; null if the configuration has none yet. */
  get fileName(): string | null {
    return this.current.path === null ? null : (this.current.path.split(/[\\/]/).pop() ?? this.current.path);
  }

  undo(): void {
    this.connection.send({ type: "undo" });
  }

  redo(): void {
    this.connection.send({ type: "redo" });
  }

  add(cls: string, name: string, group: string | null = null, topic: string | null = null): void {
    this.connection.send({ type: "add_display", cls, name, group, topic });
  }

  duplicate(displays: string[]): void {
    this.connection.send({ type: "duplicate_displays", displays });
  }

  rename(display: string, name: string): void {
    this.connection.send({ type: "rename_display", display, name });
  }

  remove(displays: string[]): void {
    this.connection.send({ type: "remove_displays", displays });
  }

  /** Moves displays into a group (null for none), before one of its displays (null for the end). */
  move(displays: string[], group: string | null, nextSibling: string | null): void {
    this.connection.send({ type: "move_displays", displays, group, before: nextSibling });
  }

  group(displays: string[], name: string): void {
    this.connection.send({ type: "group_displays", displays, name });
  }

  /** Requests the displays that can be added, and those for each topic. */
  requestChoices(): void {
    this.connection.send({ type: "request_display_choices" });
  }

  requestFolder(path: string | null): void {
    this.connection.send({ type: "request_folder", path });
  }

  /** Requests the text of the file as it would be saved now. */
  requestText(): void {
    this.connection.send({ type: "request_configuration_text" });
  }

  createFile(discardsChanges = false): void {
    this.connection.send({ type: "new_configuration", discard: discardsChanges });
  }

  open(path: string, discardsChanges = false): void {
    this.connection.send({ type: "open_configuration", path, discard: discardsChanges });
  }

  load(name: string, text: string, discardsChanges = false): void {
    this.connection.send({ type: "load_configuration", name, text, discard: discardsChanges });
  }

  revert(): void {
    this.connection.send({ type: "revert_configuration" });
  }

  save(path: string | null = null, replacesFile = false): void {
    this.connection.send({ type: "save_configuration", path, replace: replacesFile });
  }
}
