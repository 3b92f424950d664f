import type { Connection } from "../connection/connection";
import type { DiagnosticItem, Hello, LinkProvenance, PropertyValue, RobotScene } from "../protocol";
import { Signal } from "../signal";
import { openBrowserStorage } from "../storage";
import { AngleUnits } from "./angle-unit";
import { ComparisonState } from "./comparison";
import { ConfigurationState } from "./configuration";
import { CourseState } from "./course";
import { DescriptionState } from "./description";
import { DisplayDataStore } from "./display-data";
import { DisplaysState } from "./displays";
import { DrawingPace } from "./drawing-pace";
import { EditingState } from "./editing/editing";
import { ElementFocus } from "./element-focus";
import { FrameStore } from "./frames";
import { InspectState } from "./inspect";
import { JointsState } from "./joints";
import { PageMemory } from "./page-memory";
import { MeshProgress } from "./mesh-progress";
import { MotionPlanning } from "./motion-planning";
import { Modeling } from "./modeling/modeling";
import { MonitorState } from "./monitor/monitor";
import { PoseStore } from "./named-poses";
import { RecordingControl } from "./recording";
import type { SceneMenu } from "./scene-menu";
import { SelectionState } from "./selection";
import { SimulationState } from "./simulation";
import { SlowConnection } from "./slow-connection";
import { Slowness } from "./slowness";
import { TextEditorLink } from "./text-editor";
import { TerminalsState } from "./terminals";
import { TipSwitch } from "./tip/tip-switch";
import { TimeControlState } from "./time";
import { TimelineState } from "./timeline";
import { ToolsState } from "./tools";
import { TurtlesimState } from "./turtlesim";
import { ViewState } from "./view";
import { VoiceState } from "./voice/voice";
import { WordsState } from "./voice/words";

/** The state of the page, which messages from the server keep up to date. Panels and drawings listen to its parts. */
export class Session {
  /** The newest robot of each RobotModel display, by display ID. */
  readonly robots = new Map<string, RobotScene>();
  readonly frames = new FrameStore();
  readonly displays = new DisplaysState();
  readonly configuration: ConfigurationState;
  readonly joints: JointsState;
  readonly description: DescriptionState;
  readonly selection = new SelectionState(this.robots);
  readonly tipSwitch: TipSwitch;
  readonly view: ViewState;
  readonly tools: ToolsState;
  readonly time: TimeControlState;
  readonly timeline: TimelineState;
  readonly recording: RecordingControl;
  readonly comparison: ComparisonState;
  readonly data: DisplayDataStore;
  readonly slowConnection: SlowConnection;
  readonly slowness: Slowness;
  readonly meshProgress = new MeshProgress();
  readonly drawingPace = new DrawingPace();
  readonly simulation: SimulationState;
  readonly modeling: Modeling;
  readonly editing: EditingState;
  readonly motionPlanning: MotionPlanning;
  readonly robotChanged = new Signal<RobotScene>();
  readonly diagnosticsChanged = new Signal();
  /** Emitted with the answer to `request_provenance`. */
  readonly provenanceAnswered = new Signal<LinkProvenance>();
  readonly greeted = new Signal<Hello>();
  /** Emitted when a menu in the scene is to be opened. */
  readonly sceneMenu = new Signal<SceneMenu>();
  readonly focus = new ElementFocus(this.selection, this.robots);
  readonly inspect = new InspectState(openBrowserStorage());
  readonly poses = new PoseStore(openBrowserStorage());
  readonly angleUnits = new AngleUnits(openBrowserStorage());
  readonly pageMemory = new PageMemory(openBrowserStorage("sessionStorage"));
  readonly monitor: MonitorState;
  readonly voice: VoiceState;
  readonly enrolledWords: WordsState;
  readonly textEditor: TextEditorLink;
  readonly terminals: TerminalsState;
  readonly course: CourseState;
  readonly turtlesim: TurtlesimState;
  diagnostics: readonly DiagnosticItem[] = [];
  private lastHello: Hello | null = null;

  constructor(readonly connection: Connection) {
    this.configuration = new ConfigurationState(connection);
    this.view = new ViewState(this.frames, connection);
    this.tools = new ToolsState(connection);
    this.time = new TimeControlState(connection);
    this.timeline = new TimelineState(connection);
    this.recording = new RecordingControl(connection);
    this.comparison = new ComparisonState(connection);
    this.data = new DisplayDataStore(connection);
    this.slowConnection = new SlowConnection(this.data);
    this.slowness = new Slowness(this.slowConnection, this.drawingPace, connection);
    this.simulation = new SimulationState(connection);
    this.modeling = new Modeling(connection, openBrowserStorage());
    this.editing = new EditingState(connection, openBrowserStorage());
    this.joints = new JointsState(connection);
    this.motionPlanning = new MotionPlanning(connection, this.data, this.displays);
    this.description = new DescriptionState(connection);
    this.tipSwitch = new TipSwitch(this.joints, this.description, this.selection, this.frames);
    this.monitor = new MonitorState(connection, openBrowserStorage());
    this.voice = new VoiceState(connection, openBrowserStorage());
    this.enrolledWords = new WordsState(connection, this.voice);
    this.textEditor = new TextEditorLink(connection, this.focus);
    this.terminals = new TerminalsState(connection);
    this.course = new CourseState(connection);
    this.turtlesim = new TurtlesimState(connection);
    this.listen(connection);
    const followFixedFrame = (): void => {
      this.frames.fixedFrame = this.displays.fixedFrame;
    };
    this.displays.treeChanged.on(followFixedFrame);
    this.displays.valueChanged.on(followFixedFrame);
    this.registerPreservedState();
  }

  /** Registers the state that only this page has, to preserve it across a reload. */
  private registerPreservedState(): void {
    const memory = this.pageMemory;
    memory.preserve("program", () => this.lastHello, (hello) => (this.lastHello = hello));
    for (const part of [this.view, this.selection, this.focus, this.tools, this.joints]) part.preserveIn(memory);
  }

  /** Applies a user's edit of a property: shows it immediately, and sends it to the server. */
  setProperty(id: string, value: PropertyValue): void {
    this.displays.setValue(id, value, null);
    this.connection.send({ type: "set_property", id, value });
  }

  /** The first robot that has links. */
  get robot(): RobotScene | null {
    for (const display of this.displays.displays) {
      const robot = this.robots.get(display.id);
      if (robot && robot.links.length > 0) return robot;
    }
    return null;
  }

  /** Keeps joint positions and camera if the program was restarted and shows the same content. */
  private onHello(hello: Hello): void {
    const previous = this.lastHello;
    this.lastHello = hello;
    if (previous !== null && previous.run !== hello.run) {
      const isSame = previous.title === hello.title;
      this.view.onProgramRestarted(isSame);
      this.joints.onProgramRestarted(isSame);
    }
    this.greeted.emit(hello);
  }

  private listen(connection: Connection): void {
    connection.on("hello", (message) => this.onHello(message));
    connection.on("tree", (message) => {
      this.displays.setTree(message);
      for (const id of this.robots.keys()) if (!this.displays.find(id)) this.robots.delete(id);
      this.selection.keepIf(({ display }) => this.displays.find(display) !== undefined);
    });
    connection.on("display_properties", ({ display, properties }) => this.displays.setRows(display, properties));
    connection.on("property_changed", ({ id, value, options }) => this.displays.setValue(id, value, options));
    connection.on("display_status", ({ display, level, status }) => this.displays.setStatus(display, level, status));
    connection.on("robot_scene", (message) => {
      this.robots.set(message.display, message);
      this.robotChanged.emit(message);
      this.selection.onRobotChanged(message);
    });
    connection.on("frame_table", (message) => this.frames.setTable(message));
    connection.on("diagnostics", ({ items }) => {
      this.diagnostics = items;
      this.diagnosticsChanged.emit();
    });
    connection.on("link_provenance", (message) => this.provenanceAnswered.emit(message));
    connection.transforms.on((transforms) => this.frames.setTransforms(transforms));
  }
}
