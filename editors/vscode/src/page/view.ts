import { type ChildProcess, spawn } from "node:child_process";
import { dirname } from "node:path";
import { type Command, environment, extended, shown } from "../server/command.js";
import { AddressReader } from "./address.js";

/** A running `linkwright view` of one file. */
export class View {
  /** The address of the page; fails if the program ends before it prints one. */
  readonly address: Promise<string>;
  /** Resolves when the program has ended. */
  readonly ended: Promise<void>;
  private readonly child: ChildProcess;

  /**
   * @param cwd the working directory, where packages are searched too; by default the folder of the file.
   * @param log takes the output of the program.
   */
  constructor(command: Command, file: string, cwd: string | undefined, log: (text: string) => void) {
    const view = extended(command, "view", "--no-open", file);
    log(shown(view));
    const child = spawn(view.program, view.args, {
      cwd: cwd ?? dirname(file),
      env: environment(),
      stdio: ["ignore", "pipe", "pipe"],
    });
    this.child = child;
    this.ended = new Promise((resolve) => {
      child.on("close", () => resolve());
      child.on("error", () => resolve());
    });
    this.address = new Promise((resolve, reject) => {
      const reader = new AddressReader();
      child.stdout.setEncoding("utf8").on("data", (piece: string) => {
        log(piece);
        const address = reader.read(piece);
        if (address !== undefined) resolve(address);
      });
      child.stderr.setEncoding("utf8").on("data", log);
      child.on("error", reject);
      child.on("close", (status) => reject(new Error(`linkwright view ended with status ${status ?? "unknown"}`)));
    });
    this.address.catch(() => undefined); // whoever asks for the address gets the error
  }

  /** End the program; the page then says that it is gone. */
  stop(): void {
    this.child.kill();
  }
}
