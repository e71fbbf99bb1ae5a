// One of the poses that have names.
import type { NamedPose } from "../api/types";
import { messages } from "../messages";

const POSES: readonly NamedPose[] = ["standing", "relaxed", "walking", "sitting", "arms_raised", "a_pose", "t_pose", "rest"];

interface Props {
  readonly pose: NamedPose;
  readonly onChoose: (pose: NamedPose) => void;
}

export function PoseChoice({ pose, onChoose }: Props) {
  const { poses } = messages.derived;
  return (
    <div class="field">
      <label for="pose">{poses.label}</label>
      <select id="pose" value={pose} onChange={(event) => onChoose(event.currentTarget.value as NamedPose)}>
        {POSES.map((each) => (
          <option key={each} value={each}>
            {poses.names[each]}
          </option>
        ))}
      </select>
    </div>
  );
}
