/** x, y, z in m, and the unit quaternion qx, qy, qz, qw. */
export type PoseNumbers = readonly [number, number, number, number, number, number, number];

type Rotation = readonly [number, number, number, number];
type Vector = readonly [number, number, number];

/** Returns a pose `b` given in the frame `a`, in the frame in which `a` is given. */
export function composePoses(a: PoseNumbers, b: PoseNumbers): PoseNumbers {
  const [x, y, z] = rotate(rotationOf(a), positionOf(b));
  return [a[0] + x, a[1] + y, a[2] + z, ...multiply(rotationOf(a), rotationOf(b))];
}

/** Returns the pose of `b` in `a`, where both are given in the same frame. */
export function computeRelativePose(a: PoseNumbers, b: PoseNumbers): PoseNumbers {
  const [x, y, z, w] = rotationOf(a);
  const inverse: Rotation = [-x, -y, -z, w];
  return [...rotate(inverse, [b[0] - a[0], b[1] - a[1], b[2] - a[2]]), ...multiply(inverse, rotationOf(b))];
}

function positionOf([x, y, z]: PoseNumbers): Vector {
  return [x, y, z];
}

function rotationOf(pose: PoseNumbers): Rotation {
  return [pose[3], pose[4], pose[5], pose[6]];
}

function multiply([ax, ay, az, aw]: Rotation, [bx, by, bz, bw]: Rotation): Rotation {
  return [
    aw * bx + ax * bw + ay * bz - az * by,
    aw * by - ax * bz + ay * bw + az * bx,
    aw * bz + ax * by - ay * bx + az * bw,
    aw * bw - ax * bx - ay * by - az * bz,
  ];
}

function rotate([x, y, z, w]: Rotation, [a, b, c]: Vector): Vector {
  const [p, q, r] = [y * c - z * b, z * a - x * c, x * b - y * a];
  return [a + 2 * (w * p + y * r - z * q), b + 2 * (w * q + z * p - x * r), c + 2 * (w * r + x * q - y * p)];
}
