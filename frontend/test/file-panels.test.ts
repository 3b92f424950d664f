import { beforeEach, describe, expect, it, vi } from "vitest";
import { Connection } from "../src/connection/connection";
import { FilePanels, type Arrangement } from "../src/panels/dock/file-panels";
import { Layouts, type Layout } from "../src/panels/dock/layouts";
import type { PanelId } from "../src/panels/panel";
import type { Configuration, PageMessage, PanelName, ServerMessage } from "../src/protocol";
import { Signal } from "../src/signal";

/** A dock without a scene: the browser stores a list of panels for each file. */
class BareDock implements Arrangement {
  readonly changed = new Signal();
  readonly storedPanels = new Map<string, readonly PanelId[]>();
  file: string | null = null;
  panelsOfFile: readonly PanelName[] | null = null;
  isClassroom = false;
  resetCount = 0;
  shownPanels: readonly PanelId[] = ["displays", "views", "time", "links"];

  open(id: PanelId): void {
    this.changePanels([...this.shownPanels, id]);
  }

  close(id: PanelId): void {
    this.changePanels(this.shownPanels.filter((panel) => panel !== id));
  }

  isOpen(id: PanelId): boolean {
    return this.shownPanels.includes(id);
  }

  arrange(file: string): boolean {
    const panels = this.storedPanels.get(file);
    if (panels) this.shownPanels = panels;
    return panels !== undefined;
  }

  storeFor(file: string): void {
    this.file = file;
    this.storedPanels.set(file, this.shownPanels);
  }

  reset(): void {
    this.resetCount += 1;
  }

  showOnly(panels: readonly PanelName[]): void {
    this.shownPanels = [...panels, "links"];
  }

  /** An action of the user. */
  changePanels(openPanels: readonly PanelId[]): void {
    this.shownPanels = openPanels;
    if (this.file !== null) this.storedPanels.set(this.file, openPanels);
    this.changed.emit();
  }
}

let sentMessages: PageMessage[];
let connection: Connection;
let dock: BareDock;

function receive(...messages: ServerMessage[]): void {
  for (const message of messages) connection.message.emit(message);
}

function receiveHello(): void {
  receive({ type: "hello", protocol: 0, version: "", title: "", run: "1" });
}

function createConfiguration(part: Partial<Configuration>): Configuration {
  return { type: "configuration", path: null, opened: 1, unsaved: false, undo: null, redo: null, is_own: false, recent: [], ...part };
}

/** The messages that a page receives when it connects, or when another configuration is opened. */
function receivePanels(opened: number, path: string | null, shownPanels: PanelName[] | null, origin = "<default>"): void {
  receive({ type: "panels", opened, origin, shown: shownPanels }, createConfiguration({ opened, path }));
}

beforeEach(() => {
  sentMessages = [];
  connection = new Connection("ws://localhost/ws");
  vi.spyOn(connection, "send").mockImplementation((message) => void sentMessages.push(message));
  dock = new BareDock();
  new FilePanels(connection, dock);
  receiveHello();
});

describe("the panels of a file", () => {
  it("are opened when the browser sees the file for the first time", () => {
    receivePanels(1, "/a.rviz", ["displays", "views"]);
    expect(dock.shownPanels).toEqual(["displays", "views", "links"]);
    expect([dock.file, dock.panelsOfFile]).toEqual(["/a.rviz", ["displays", "views"]]);
    expect(sentMessages).toEqual([]);
  });

  it("stay unchanged if the file does not specify any", () => {
    receivePanels(1, "/a.rviz", null);
    expect(dock.shownPanels).toEqual(["displays", "views", "time", "links"]);
  });

  it("are the user's if the browser knows the file", () => {
    dock.storedPanels.set("/a.rviz", ["time", "plot"]);
    receivePanels(1, "/a.rviz", ["displays", "views"]);
    expect(dock.shownPanels).toEqual(["time", "plot"]);
    expect(sentMessages).toEqual([]);
  });

  it("are the file's again when it is opened from the menu", () => {
    dock.storedPanels.set("/b.rviz", ["time", "plot"]);
    receivePanels(1, "/a.rviz", ["displays"]);
    receivePanels(2, "/b.rviz", ["views"]);
    expect(dock.shownPanels).toEqual(["views", "links"]);
    dock.changePanels(["plot"]);
    receivePanels(3, "/b.rviz", ["views"]);
    expect(dock.shownPanels).toEqual(["views", "links"]);
  });

  it("are known once both messages about a configuration have arrived, in either order", () => {
    receivePanels(1, "/a.rviz", ["displays"]);
    receive(createConfiguration({ opened: 2, path: "/b.rviz" }));
    expect(dock.file).toBe("/a.rviz");
    receive({ type: "panels", opened: 2, origin: "", shown: ["time"] });
    expect([dock.file, dock.shownPanels]).toEqual(["/b.rviz", ["time", "links"]]);
  });
});

describe("a course", () => {
  const course: ServerMessage = { type: "course", title: { en: "A course" }, folder: "/ws", file: "", lessons: [] };

  it("arranges the panels when it is shown for the first time", () => {
    receive(course);
    receivePanels(1, null, ["displays"], "/ws");
    expect([dock.isClassroom, dock.resetCount]).toEqual([true, 1]);
    receive(course);
    expect(dock.resetCount).toBe(1);
  });

  it("leaves the panels as the user arranged them", () => {
    dock.storedPanels.set("/ws", ["lesson", "plot"]);
    receivePanels(1, null, ["displays"], "/ws");
    receive(course);
    expect([dock.isClassroom, dock.resetCount, dock.shownPanels]).toEqual([true, 0, ["lesson", "plot"]]);
  });
});

describe("a page for turtles alone", () => {
  const turtles: ServerMessage = { type: "turtle_simulators", simulators: [{ number: 1, name: "/turtlesim" }] };

  it.each([true, false])("has no panels for descriptions when it is shown for the first time", (isEarly) => {
    if (isEarly) receive(turtles);
    receivePanels(1, null, ["time"], "<window>");
    if (!isEarly) receive(turtles);
    expect(dock.shownPanels).toEqual(["time"]);
    dock.open("links");
    receive(turtles);
    expect(dock.shownPanels).toEqual(["time", "links"]);
  });

  it("keeps them beside the displays of RViz", () => {
    receive(turtles);
    receivePanels(1, "/a.rviz", ["displays"]);
    expect(dock.shownPanels).toEqual(["displays", "links"]);
  });
});

describe("changes by the user", () => {
  it("are sent once, and only for panels that files can name", () => {
    receivePanels(1, "/a.rviz", ["displays", "views"]);
    dock.changePanels(["displays", "views", "links", "plot"]);
    expect(sentMessages).toEqual([]);
    dock.changePanels(["displays", "plot"]);
    dock.changePanels(["displays", "log"]);
    expect(sentMessages).toEqual([{ type: "show_panels", shown: ["displays"] }]);
  });

  it("are not sent before the file is known", () => {
    dock.changePanels(["displays"]);
    expect(sentMessages).toEqual([]);
  });

  it("continue under the name that the file is saved under", () => {
    receivePanels(1, null, ["displays"]);
    expect(dock.file).toBe("<default>");
    dock.changePanels(["displays", "time"]);
    receive(createConfiguration({ opened: 1, path: "/new.rviz" }));
    expect([dock.file, dock.shownPanels]).toEqual(["/new.rviz", ["displays", "time"]]);
    expect(dock.storedPanels.get("/new.rviz")).toEqual(["displays", "time"]);
  });

  it("survive a reconnection", () => {
    receivePanels(1, "/a.rviz", ["displays", "views"]);
    dock.changePanels(["time"]);
    receiveHello();
    receivePanels(1, "/a.rviz", ["time"]);
    expect(dock.shownPanels).toEqual(["time"]);
    receiveHello(); // another program
    receivePanels(1, "/c.rviz", ["views"]);
    expect(dock.shownPanels).toEqual(["views", "links"]);
    expect(sentMessages).toHaveLength(1);
  });
});

describe("the arrangements stored in the browser", () => {
  const texts = new Map<string, string>();
  const layouts = new Layouts({ getItem: (key) => texts.get(key) ?? null, setItem: (key, text) => void texts.set(key, text) });
  const createLayout = (file: string, form: Layout["form"] = "wide"): Layout => ({ file, form, arrangement: { panels: {} } as Layout["arrangement"] });

  beforeEach(() => texts.clear());

  it("are those of the last files, newest first", () => {
    expect([layouts.findLatest("wide"), layouts.find("/0.rviz", "wide")]).toEqual([null, null]);
    for (let i = 0; i < 20; i++) layouts.store(createLayout(`/${i}.rviz`));
    expect(layouts.findLatest("wide")?.file).toBe("/19.rviz");
    expect(layouts.find("/8.rviz", "wide")?.file).toBe("/8.rviz");
    expect(layouts.find("/7.rviz", "wide")).toBeNull();
    layouts.store(createLayout("/8.rviz"));
    expect(layouts.findLatest("wide")?.file).toBe("/8.rviz");
  });

  it("differ by the form of the window", () => {
    layouts.store(createLayout("/a.rviz", "narrow"));
    layouts.store(createLayout("/b.rviz"));
    expect(layouts.findLatest("narrow")?.file).toBe("/a.rviz");
    expect(layouts.find("/a.rviz", "wide")).toBeNull();
    layouts.store(createLayout("/a.rviz"));
    expect(layouts.find("/a.rviz", "narrow")?.form).toBe("narrow");
    expect(layouts.find("/a.rviz", "wide")?.form).toBe("wide");
    expect(layouts.find("/a.rviz", "low")).toBeNull();
  });

  it("are empty if the stored value is invalid", () => {
    for (const text of ["{", "7", '{"file": 1}', '[{"file": "/a.rviz", "arrangement": {}}]', "[null, 3, {}]"]) {
      texts.set("linkwright.layouts.3", text);
      expect(layouts.findLatest("wide")).toBeNull();
    }
  });
});

describe("the voice panel", () => {
  const createVoiceNode = (isPresent: boolean): ServerMessage => ({ type: "voice_node", present: isPresent });

  it("opens for a robot that listens, even if a file names its open panels, in either order", () => {
    receive(createVoiceNode(false));
    receivePanels(1, "/a.rviz", ["displays"]);
    expect(dock.isOpen("voice")).toBe(false);
    receive(createVoiceNode(true));
    expect(dock.isOpen("voice")).toBe(true);
  });

  it("stays closed after the user has closed it", () => {
    receive(createVoiceNode(true));
    receivePanels(1, "/a.rviz", ["displays"]);
    expect(dock.isOpen("voice")).toBe(true);
    dock.changePanels(["displays"]);
    receive(createVoiceNode(true));
    receiveHello();
    receivePanels(1, "/a.rviz", ["displays"]);
    receive(createVoiceNode(true));
    expect(dock.isOpen("voice")).toBe(false);
  });
});

describe("the teleop pad", () => {
  const createSimulation = (isDrivable: boolean): ServerMessage => ({
    type: "simulation_status", present: true, drivable: isDrivable, paused: false, time: null, real_time_factor: null,
  });

  it("opens for a simulated robot that drives, in either order", () => {
    receivePanels(1, null, ["displays"], "robot.urdf");
    receive(createSimulation(false));
    expect(dock.isOpen("teleop")).toBe(false);
    receive(createSimulation(true));
    expect(dock.isOpen("teleop")).toBe(true);
    receivePanels(2, null, ["displays"], "other.urdf");
    expect(dock.isOpen("teleop")).toBe(true);
  });

  it("stays closed after the user has closed it", () => {
    receivePanels(1, null, ["displays"], "robot.urdf");
    receive(createSimulation(true));
    dock.changePanels(["displays"]);
    receive(createSimulation(false), createSimulation(true));
    receiveHello();
    receivePanels(1, null, ["displays"], "robot.urdf");
    receive(createSimulation(true));
    expect(dock.isOpen("teleop")).toBe(false);
  });

  it("stays closed if a file names its open panels", () => {
    receivePanels(1, "/a.rviz", ["displays"]);
    receive(createSimulation(true));
    expect(dock.isOpen("teleop")).toBe(false);
  });
});
