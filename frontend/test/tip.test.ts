import { describe, expect, it } from "vitest";
import type { Description, JointControl, JointDetails, LinkDetails } from "../src/protocol";
import { DescriptionModel } from "../src/state/description-model";
import { composePoses, computeRelativePose, type PoseNumbers } from "../src/state/pose-numbers";
import { Chain, listBases } from "../src/state/tip/chain";
import { solveTip } from "../src/state/tip/solver";

type JointPart = Partial<JointDetails> & { readonly control?: Partial<JointControl> };

/** Returns a robot of joints in a row, link 0 to link n, and the controls of its joints. */
function createRow(parts: readonly JointPart[]): { model: DescriptionModel; controls: JointControl[] } {
  const joints = parts.map((part, i) => {
    const place = { name: `j${i}`, parent: `l${i}`, child: `l${i + 1}`, xyz: [0, 0, 0.3], quaternion: [0, 0, 0, 1] };
    return { kind: "revolute", axis: [0, 1, 0], lower: -2.5, upper: 2.5, mimic: null, written: {}, ...place, ...part } as unknown as JointDetails;
  });
  const links = [...parts, {}].map((_, i) => ({ name: `l${i}`, parent_joint: i > 0 ? `j${i - 1}` : null, written: {} }) as unknown as LinkDetails);
  const controls = joints.flatMap((joint, i): JointControl[] => {
    const limits = { lower: joint.lower ?? -Math.PI, upper: joint.upper ?? Math.PI, zero: 0, mimic: null, multiplier: 1, offset: 0 };
    return joint.kind === "fixed" || joint.kind === "floating" || joint.kind === "planar" ? [] : [{ name: joint.name, kind: joint.kind, ...limits, ...parts[i]?.control }];
  });
  const description = { display: "robot", root: "l0", links, joints } as unknown as Description;
  return { model: new DescriptionModel(description), controls };
}

const AXES = [[0, 0, 1], [0, 1, 0], [0, 1, 0], [1, 0, 0], [0, 1, 0], [1, 0, 0], [0, 0, 1]];

function createArm(size: number): Chain {
  const { model, controls } = createRow(AXES.slice(0, size).map((axis) => ({ axis, quaternion: [0.1, 0, 0, Math.sqrt(0.99)] })));
  return chainOf({ model, controls }, `l${size}`);
}

function chainOf({ model, controls }: { model: DescriptionModel; controls: JointControl[] }, tip: string, base: string | null = null): Chain {
  const chain = Chain.create(model, controls, tip, base);
  if (!chain) throw new Error("no chain");
  return chain;
}

/** Returns numbers from -1 to 1 that are the same in each run. */
function createRandom(): () => number {
  let state = 7;
  return () => {
    state = (state * 16807) % 2147483647;
    return (2 * state) / 2147483647 - 1;
  };
}

describe("the chain to a tip", () => {
  it("has the Jacobian of finite differences, with mimic and prismatic joints", () => {
    const mimic = { mimic: "j0", multiplier: -0.5, offset: 0.2 };
    const row = createRow([{}, { axis: [1, 0, 0], control: mimic }, { kind: "prismatic", axis: [0, 0, 1] }, { kind: "continuous", axis: [0, 0, 1] }]);
    const chain = chainOf(row, "l4");
    expect(chain.variables.map(({ name }) => name)).toEqual(["j0", "j2", "j3"]);
    const positions = [0.4, 0.1, -0.7];
    const { pose, jacobian } = chain.computeMotion(positions);
    const step = 1e-5;
    positions.forEach((_, i) => {
      const moved = chain.computeMotion(positions.map((position, k) => (k === i ? position + step : position))).pose;
      const inverse = computeRelativePose([0, 0, 0, pose[3], pose[4], pose[5], pose[6]], [0, 0, 0, 0, 0, 0, 1]);
      const turn = composePoses([0, 0, 0, moved[3], moved[4], moved[5], moved[6]], inverse);
      const numeric = [moved[0] - pose[0], moved[1] - pose[1], moved[2] - pose[2], 2 * turn[3], 2 * turn[4], 2 * turn[5]];
      numeric.forEach((component, k) => expect(jacobian[i]?.[k]).toBeCloseTo(component / step, 3));
    });
  });

  it("starts at the topmost joint that moves, or at the chosen link", () => {
    const row = createRow([{ kind: "fixed" }, {}, { kind: "fixed" }, {}, { kind: "fixed" }]);
    expect(chainOf(row, "l5").base).toBe("l1");
    expect(listBases(row.model, row.controls, "l5")).toEqual(["l1", "l2", "l3"]);
    expect(chainOf(row, "l5", "l3").variables.map(({ name }) => name)).toEqual(["j3"]);
    expect(Chain.create(row.model, row.controls, "l1", null)).toBeNull();
  });

  it("ends below a joint without a slider", () => {
    expect(chainOf(createRow([{}, { kind: "floating" }, {}]), "l3").base).toBe("l2");
  });

  it("keeps a mimic joint within its own limits", () => {
    const row = createRow([{}, { lower: -0.4, upper: 0.4, control: { mimic: "j0", multiplier: 2 } }]);
    expect(chainOf(row, "l2").variables).toEqual([{ name: "j0", lower: -0.2, upper: 0.2, isEndless: false }]);
  });
});

describe("the joint positions for a tip", () => {
  it.each([6, 7])("are found along a path of a chain with %i joints, without jumps", (size) => {
    const chain = createArm(size);
    const random = createRandom();
    for (let run = 0; run < 30; run++) {
      let positions: readonly number[] = chain.variables.map(() => random());
      const goal = positions.map((position) => position + 0.3 * random());
      for (let i = 1; i <= 20; i++) {
        const between = goal.map((position, k) => (chain.variables[k] ? position * (i / 20) + (positions[k] ?? 0) * (1 - i / 20) : 0));
        const solution = solveTip(chain, positions, chain.computeMotion(between).pose, "turn");
        expect(solution.isReached).toBe(true);
        solution.positions.forEach((position, k) => expect(Math.abs(position - (positions[k] ?? 0))).toBeLessThan(0.5));
        positions = solution.positions;
      }
    }
  });

  it("stretch a chain towards a target out of reach, within the limits", () => {
    const chain = chainOf(createRow([{ upper: 1 }, {}, { kind: "fixed" }]), "l3");
    const solution = solveTip(chain, [0.2, 0.3], [5, 0, 0.3, 0, 0, 0, 1], "move");
    expect(solution.isReached).toBe(false);
    expect(solution.positions[0]).toBeLessThanOrEqual(1);
    const [x, , z] = chain.computeMotion(solution.positions).pose;
    // The lower joint is at its limit, and the upper part points at the target.
    const [elbowX, elbowZ] = [0.3 * Math.sin(1), 0.3 + 0.3 * Math.cos(1)];
    const direction = Math.atan2(5 - elbowX, 0.3 - elbowZ);
    expect(x).toBeCloseTo(elbowX + 0.3 * Math.sin(direction), 2);
    expect(z).toBeCloseTo(elbowZ + 0.3 * Math.cos(direction), 2);
  });

  it("leave a straight pose", () => {
    const chain = chainOf(createRow([{}, {}, { kind: "fixed" }]), "l3");
    const target: PoseNumbers = [0, 0, 0.7, 0, 0, 0, 1];
    expect(solveTip(chain, [0, 0], target, "move").isReached).toBe(true);
  });

  it("of endless joints stay within a turn", () => {
    const chain = chainOf(createRow([{ kind: "continuous", lower: null, upper: null, axis: [0, 0, 1] }]), "l1");
    const target: PoseNumbers = [0, 0, 0.3, 0, 0, Math.sin(1.7), Math.cos(1.7)];
    const [position = 0] = solveTip(chain, [3], target, "turn").positions;
    expect(position).toBeCloseTo(3.4 - 2 * Math.PI, 3);
  });
});
