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
  "navigation",
];

/** The part of the dock that `FilePanels` uses. */
export interface Arrangement {
  readonly changed: Signal;
  readonly file: string | null;
  listed: readonly PanelName[] | null;
  isOpen(id: PanelId): boolean;
  /** Shows the arrangement that the browser stores for a file; returns false if there is none. */
  arrange(file: string): boolean;
  keepFor(file: string): void;
  open(id: PanelId): void;
  showOnly(panels: readonly PanelName[]): void;
}

/**
 * Synchronizes the open panels with those of the file.
 *
 * A page that opens uses the arrangement that the browser stores for the file. Where there is none, and whenever
 * another configuration replaces the current one, the file specifies the open panels. The browser stores the panels
 * that the user opens and closes afterwards, and the server, which receives them, writes them into the file.
 */
export class FilePanels {
  private told: Panels | null = null;
  private configuration: Configuration | null = null;
  /** The number of the configuration shown; null after connecting, until one is known. */
  private shown: number | null = null;
  /** The file's panels that were open at the last comparison. */
  private open: readonly PanelName[] | null = null;
  /** Neither a file nor the browser specifies the arrangement of this page's panels. */
  private unarranged = false;
  private drivable = false;
  /** Whether the browser stores no arrangement for the file. */
  private isFirstVisit = false;
  private listens = false;

  constructor(
    private readonly connection: Connection,
    private readonly dock: Arrangement,
  ) {
    connection.on("hello", () => {
      this.told = this.configuration = this.shown = null;
      this.drivable = this.listens = false;
    });
    connection.on("panels", (message) => {
      this.told = message;
      this.settle();
    });
    connection.on("configuration", (message) => {
      this.configuration = message;
      this.settle();
    });
    connection.on("simulation_status", ({ drivable }) => {
      this.drivable = drivable;
      this.openPad();
    });
    connection.on("voice_node", ({ present }) => {
      this.listens = present;
      this.openVoice();
    });
    dock.changed.on(() => this.compare());
  }

  /** Opens the Teleop panel for a simulated robot that can be driven, unless the arrangement is specified. */
  private openPad(): void {
    if (!this.drivable || !this.unarranged) return;
    this.unarranged = false;
    this.dock.open("teleop");
  }

  /** Opens the Voice panel for a robot that listens, if the file is shown for the first time. */
  private openVoice(): void {
    if (!this.listens || !this.isFirstVisit) return;
    this.isFirstVisit = false;
    this.dock.open("voice");
  }

  /** Applies the configuration once both messages about it have arrived. */
  private settle(): void {
    const { told, configuration, dock } = this;
    if (!told || told.opened !== configuration?.opened) return;
    const { opened } = told;
    const file = configuration.path ?? told.origin;
    if (this.shown === opened) {
      if (file !== dock.file) dock.keepFor(file); // it was saved under another name
      return;
    }
    const isNews = this.shown !== null;
    this.shown = opened;
    dock.listed = told.shown;
    const isKept = file === dock.file || dock.arrange(file);
    dock.keepFor(file);
    if (told.shown && (isNews || !isKept)) dock.showOnly(told.shown);
    this.open = this.openNow;
    this.unarranged = configuration.path === null && !isKept;
    this.openPad();
    this.isFirstVisit = !isKept;
    this.openVoice();
  }

  private compare(): void {
    const open = this.openNow;
    if (this.open === null || String(open) === String(this.open)) return;
    this.open = open;
    this.connection.send({ type: "show_panels", shown: open });
  }

  private get openNow(): PanelName[] {
    return FILE_PANELS.filter((id) => this.dock.isOpen(id));
  }
}
