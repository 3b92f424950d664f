import type { Display, Property, PropertyValue, StatusLevel, StatusRow, Tree } from "../protocol";
import { Signal } from "../signal";
import { PropertyNode, PropertyRows } from "./properties";

const GROUP_CLASS = "rviz_common/Group";

/** The level shown for a row: the server's, or "loading" while its data is being loaded. */
export type ShownLevel = StatusLevel | "loading";

/** Returns the status rows that are not "ok", errors first. */
export function problemsOf(status: readonly StatusRow[]): StatusRow[] {
  return [...status.filter((row) => row.level === "error"), ...status.filter((row) => row.level === "warn")];
}

/** A display as the server describes it. */
export class DisplayState {
  readonly id: string;
  readonly cls: string;
  /** The class whose drawing is used: the display's own, or for a display of another package the one that it names. */
  readonly drawing: string;
  name = "";
  /** Whether its own box is ticked. */
  isChecked = false;
  /** The group that contains it. */
  group: DisplayState | null = null;
  isSupported = false;
  level: StatusLevel = "ok";
  status: readonly StatusRow[] = [];
  rows = new PropertyRows([]);

  constructor(display: Display) {
    this.id = display.id;
    this.cls = display.cls;
    this.drawing = display.drawing;
    this.update(display);
  }

  /** The status rows that are not "ok", errors first; empty while the display is disabled. */
  get problems(): StatusRow[] {
    return this.isEnabled ? problemsOf(this.status) : [];
  }

  get enabledId(): string {
    return `${this.id}/Enabled`;
  }

  /** Whether the display is drawn: its box and those of all groups around it are ticked. */
  get isEnabled(): boolean {
    return this.isChecked && (this.group?.isEnabled ?? true);
  }

  /** Whether it is a group of displays. */
  get isGroup(): boolean {
    return this.cls === GROUP_CLASS;
  }

  /** Whether it is in a group, at any depth. */
  isWithin(group: DisplayState): boolean {
    return this.group !== null && (this.group === group || this.group.isWithin(group));
  }

  update(display: Display): void {
    this.name = display.name;
    this.isChecked = display.enabled;
    this.isSupported = display.supported;
    this.level = display.level;
    this.status = display.status;
    this.setProperties(display.properties);
  }

  setProperties(properties: readonly Property[]): void {
    // The enable box is in the display's own row.
    const rows = properties.filter((property) => property.id !== this.enabledId);
    this.rows = new PropertyRows(rows.map((property) => new PropertyNode(property)));
  }
}

/** The server's tree of displays: global options, global status and every display. */
export class DisplaysState {
  /** Displays were added or removed. */
  readonly treeChanged = new Signal();
  /** The rows below a display were replaced. */
  readonly rowsChanged = new Signal<DisplayState>();
  readonly statusChanged = new Signal<DisplayState | null>();
  readonly enabledChanged = new Signal<DisplayState>();
  /** A value changed; `display` is null for a global option. */
  readonly valueChanged = new Signal<{ node: PropertyNode; display: DisplayState | null }>();
  /** The user asked for the row of a display in the list. */
  readonly rowRequested = new Signal<DisplayState>();
  readonly displays: DisplayState[] = [];
  globalOptions = new PropertyRows([]);
  globalStatus: readonly StatusRow[] = [];
  globalLevel: StatusLevel = "ok";
  /** Whether the server has sent the displays. */
  isKnown = false;
  /** Returns whether something of a display is still loading, such as its meshes; set by the scene. */
  isLoading: (display: DisplayState) => boolean = () => false;
  private rowOwners = new Map<string, { node: PropertyNode; display: DisplayState | null }>();

  setTree(tree: Tree): void {
    const displaysById = new Map(this.displays.map((display) => [display.id, display]));
    const updatedDisplays = tree.displays.map((display) => {
      const existing = displaysById.get(display.id);
      if (existing?.cls !== display.cls) return new DisplayState(display);
      existing.update(display);
      return existing;
    });
    this.displays.splice(0, this.displays.length, ...updatedDisplays);
    for (const [index, { group }] of tree.displays.entries()) {
      const display = updatedDisplays[index];
      if (display) display.group = (group !== null && updatedDisplays.find((candidate) => candidate.id === group)) || null;
    }
    this.globalOptions = new PropertyRows(tree.global_options.map((property) => new PropertyNode(property)));
    this.globalStatus = tree.global_status;
    this.globalLevel = tree.global_level;
    this.isKnown = true;
    this.indexRows();
    this.treeChanged.emit();
  }

  setRows(id: string, properties: readonly Property[]): void {
    const display = this.find(id);
    if (!display) return;
    display.setProperties(properties);
    this.indexRows();
    this.rowsChanged.emit(display);
  }

  setStatus(id: string, level: StatusLevel, status: readonly StatusRow[]): void {
    if (id === "global") {
      this.globalLevel = level;
      this.globalStatus = status;
      this.statusChanged.emit(null);
      return;
    }
    const display = this.find(id);
    if (!display) return;
    display.level = level;
    display.status = status;
    this.statusChanged.emit(display);
  }

  setValue(id: string, value: PropertyValue, options: readonly string[] | null): void {
    const owner = this.rowOwners.get(id);
    if (owner) {
      if (owner.node.value === value && !options) return;
      owner.node.value = value;
      if (options) owner.node.options = options;
      this.valueChanged.emit(owner);
      return;
    }
    const display = this.displays.find((candidate) => candidate.enabledId === id);
    if (!display || typeof value !== "boolean" || display.isChecked === value) return;
    const wereEnabled = this.displays.map((display) => display.isEnabled);
    display.isChecked = value;
    for (const [index, candidate] of this.displays.entries()) {
      if (candidate === display || candidate.isEnabled !== wereEnabled[index]) this.enabledChanged.emit(candidate);
    }
  }

  /** Returns the level to show for a display: while it is loading, it is not "ok". */
  levelOf(display: DisplayState): ShownLevel {
    return display.level === "ok" && display.isEnabled && this.isLoading(display) ? "loading" : display.level;
  }

  /** Returns the displays in a group, or the top-level ones for null, in their order. */
  childrenOf(group: DisplayState | null): DisplayState[] {
    return this.displays.filter((display) => display.group === group);
  }

  /** The number of enabled displays with an error; the global status counts as one. */
  get failingCount(): number {
    const problems = [problemsOf(this.globalStatus), ...this.displays.map((display) => display.problems)];
    return problems.filter(([worst]) => worst?.level === "error").length;
  }

  find(id: string): DisplayState | undefined {
    return this.displays.find((display) => display.id === id);
  }

  get fixedFrame(): string {
    return this.globalOptions.text("", "Fixed Frame");
  }

  /** Whether a sky and a ground are behind the scene instead of the background color. */
  get hasBackdrop(): boolean {
    return this.globalOptions.text("Color", "Backdrop") !== "Color";
  }

  private indexRows(): void {
    this.rowOwners = new Map();
    const addRows = (rows: PropertyRows, display: DisplayState | null): void => {
      for (const topNode of rows.nodes) for (const node of topNode.walk()) this.rowOwners.set(node.id, { node, display });
    };
    addRows(this.globalOptions, null);
    for (const display of this.displays) addRows(display.rows, display);
  }
}

/** Display classes that show no data in the scene. */
const CLASSES_WITHOUT_DATA = new Set(["rviz_default_plugins/Grid", "rviz_default_plugins/Image"]);

/** Returns whether no enabled display shows data in the scene. */
export function isSceneEmpty({ displays }: DisplaysState): boolean {
  return displays.every((display) => !display.isEnabled || display.isGroup || CLASSES_WITHOUT_DATA.has(display.drawing));
}
