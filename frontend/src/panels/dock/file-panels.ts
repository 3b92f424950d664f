import type { Connection } from "../../connection/connection";
import type { Configuration, PanelName, Panels } from "../../protocol";
import type { Signal } from "../../signal";
import type { PanelId } from "../panel";

/** The panels that files can list. */
export const FILE_PANELS: readonly PanelName[] = [
  "displays",
  "selection",
  "tool-properties",
  "views",
  "time",
  "transformation",
  "help",
  "navigation",
  "visual-tools",
];

/** Panels that are open at first, and that files cannot list. */
const DESCRIPTION_PANELS: readonly PanelId[] = ["links", "diagnostics"];

/** The part of the dock that `FilePanels` uses. */
export interface Arrangement {
  readonly changed: Signal;
  readonly file: string | null;
  panelsOfFile: readonly PanelName[] | null;
  isClassroom: boolean;
  isOpen(id: PanelId): boolean;
  /** Shows the arrangement that the browser stores for a file; returns false if there is none. */
  arrange(file: string): boolean;
  storeFor(file: string): void;
  open(id: PanelId): void;
  close(id: PanelId): void;
  showOnly(panels: readonly PanelName[]): void;
  reset(): void;
}

/**
 * Synchronizes the open panels with those of the file.
 *
 * A page that opens uses the arrangement that the browser stores for the file. Where there is none, and whenever
 * another configuration replaces the current one, the file specifies the open panels. The browser stores the panels
 * that the user opens and closes afterwards, and the server, which receives them, writes them into the file.
 */
export class FilePanels {
  private panelsMessage: Panels | null = null;
  private configuration: Configuration | null = null;
  /** The number of the configuration shown; null after connecting, until one is known. */
  private shownNumber: number | null = null;
  /** The file's panels that were open at the last comparison. */
  private lastOpenPanels: readonly PanelName[] | null = null;
  /** Whether neither a file nor the browser specifies the arrangement of this page's panels. */
  private isUnarranged = false;
  private isDrivable = false;
  /** Whether the browser stores no arrangement for the file. */
  private isFirstVisit = false;
  private hasVoice = false;
  private hasCourse = false;
  private hasTurtles = false;

  constructor(
    private readonly connection: Connection,
    private readonly dock: Arrangement,
  ) {
    connection.on("hello", () => {
      this.panelsMessage = this.configuration = this.shownNumber = null;
      this.isDrivable = this.hasVoice = this.hasCourse = this.hasTurtles = false;
    });
    connection.on("panels", (message) => {
      this.panelsMessage = message;
      this.apply();
    });
    connection.on("configuration", (message) => {
      this.configuration = message;
      this.apply();
    });
    connection.on("simulation_status", ({ drivable }) => {
      this.isDrivable = drivable;
      this.openTeleop();
    });
    connection.on("voice_node", ({ present }) => {
      this.hasVoice = present;
      this.openVoice();
    });
    connection.on("course", () => {
      this.hasCourse = true;
      this.openCourse();
    });
    connection.on("turtle_simulators", ({ simulators }) => {
      this.hasTurtles = simulators.length > 0;
      this.makeRoomForTurtles();
    });
    dock.changed.on(() => this.sendOpenPanels());
  }

  /** Opens the Teleop panel for a simulated robot that can be driven, unless the arrangement is specified. */
  private openTeleop(): void {
    if (!this.isDrivable || !this.isUnarranged) return;
    this.isUnarranged = false;
    this.dock.open("teleop");
  }

  /** Opens the Voice panel for a robot that listens, if the file is shown for the first time. */
  private openVoice(): void {
    if (!this.hasVoice || !this.isFirstVisit) return;
    this.isFirstVisit = false;
    this.dock.open("voice");
  }

  /** Arranges the panels for a course, if it is shown for the first time. */
  private openCourse(): void {
    if (!this.hasCourse) return;
    this.dock.isClassroom = true;
    if (!this.isFirstVisit) return;
    this.isFirstVisit = false;
    this.dock.reset();
  }

  /** Closes the panels for descriptions in a page for turtles alone, if it is shown for the first time. */
  private makeRoomForTurtles(): void {
    if (!this.hasTurtles || !this.isFirstVisit || this.dock.isOpen("displays")) return;
    this.isFirstVisit = false;
    for (const id of DESCRIPTION_PANELS) this.dock.close(id);
  }

  /** Applies the configuration once both messages about it have arrived. */
  private apply(): void {
    const { panelsMessage, configuration, dock } = this;
    if (!panelsMessage || panelsMessage.opened !== configuration?.opened) return;
    const { opened } = panelsMessage;
    const file = configuration.path ?? panelsMessage.origin;
    if (this.shownNumber === opened) {
      if (file !== dock.file) dock.storeFor(file); // the file was saved under another name
      return;
    }
    const isReplaced = this.shownNumber !== null;
    this.shownNumber = opened;
    dock.panelsOfFile = panelsMessage.shown;
    const isStored = file === dock.file || dock.arrange(file);
    dock.storeFor(file);
    if (panelsMessage.shown && (isReplaced || !isStored)) dock.showOnly(panelsMessage.shown);
    this.lastOpenPanels = this.openPanels;
    this.isUnarranged = configuration.path === null && !isStored;
    this.openTeleop();
    this.isFirstVisit = !isStored;
    this.openVoice();
    this.openCourse();
    this.makeRoomForTurtles();
  }

  private sendOpenPanels(): void {
    const openPanels = this.openPanels;
    if (this.lastOpenPanels === null || String(openPanels) === String(this.lastOpenPanels)) return;
    this.lastOpenPanels = openPanels;
    this.connection.send({ type: "show_panels", shown: openPanels });
  }

  private get openPanels(): PanelName[] {
    return FILE_PANELS.filter((id) => this.dock.isOpen(id));
  }
}
