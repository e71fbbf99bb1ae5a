// One of the poses that have names.
import type { NamedPose } from "../api/types";

const POSES: readonly { value: NamedPose; label: string }[] = [
  { value: "standing", label: "Standing" },
  { value: "relaxed", label: "Relaxed" },
  { value: "walking", label: "Walking" },
  { value: "sitting", label: "Sitting" },
  { value: "arms_raised", label: "Arms raised" },
  { value: "a_pose", label: "A pose" },
  { value: "t_pose", label: "T pose" },
  { value: "rest", label: "The model’s own" },
];

interface Props {
  readonly pose: NamedPose;
  readonly onChoose: (pose: NamedPose) => void;
}

export function PoseChoice({ pose, onChoose }: Props) {
  return (
    <div class="field">
      <label for="pose">Pose</label>
      <select id="pose" value={pose} onChange={(event) => onChoose(event.currentTarget.value as NamedPose)}>
        {POSES.map(({ value, label }) => (
          <option key={value} value={value}>
            {label}
          </option>
        ))}
      </select>
    </div>
  );
}
