"""`lagnet demo --route motion`: physics hidden in a position-controlled arm, found from commands and positions."""

from __future__ import annotations

from pathlib import Path

FITTED, HELD_OUT = (20.0, 20.0), 12.0  # [s] of the recordings


def demonstrate_on_motion(out: Path, seed: int) -> None:
    """Hides an effect in each servo, diagnoses recordings without torque, opens the envelope and compares.

    Raises:
        MissingExtraError: PyBullet is not installed.
    """
    from lagnet.cli.parts.envelope import say_opened, seal
    from lagnet.cli.shared.console import say
    from lagnet.diagnosis.motion.diagnose import diagnose_motion
    from lagnet.diagnosis.motion.writing import write_motion_diagnosis
    from lagnet.recordings.loading.load import load_recording
    from lagnet.recordings.writing import write_recording
    from lagnet.reports.motion_report import write_motion_report
    from lagnet.rigid_body.robot import load_description
    from lagnet.servos.servo_file import read_servo_file
    from lagnet.simulation.servo_arm import draw_hidden, record_motion, truth_of, write_desk_arm, write_servos

    recordings = out / "recordings"
    recordings.mkdir(parents=True, exist_ok=True)
    robot = load_description(write_desk_arm(out / "desk_arm.urdf"))
    hidden = draw_hidden(robot.n_dof, seed)
    seal_of_truth = seal(truth_of(hidden, robot.joints), out)
    say(f"1. Physics is hidden in the servos of a desk arm; the envelope has sha256 {seal_of_truth}")
    paths = []
    for index, seconds in enumerate((*FITTED, HELD_OUT)):
        recording = record_motion(robot, hidden, seconds, 100 * seed + index)
        paths.append(write_recording(recording, recordings / f"motion_{index}.csv"))
        say(f"   recorded {paths[-1]}")
    say("2. The diagnosis is given commands and positions, the plain URDF and the nominal servos")
    servo = read_servo_file(write_servos(out / "servo.toml"), robot.joints, robot.armature)
    read = [load_recording(path, robot=robot) for path in paths]
    result = diagnose_motion(read[:-1], robot, read[-1:], servo=servo, seed=seed)
    write_motion_diagnosis(result, out)
    write_motion_report(result, out / "report.html")
    say_opened(out, result.verdict.to_dict(), out / "report.html")
