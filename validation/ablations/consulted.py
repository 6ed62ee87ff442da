"""Which rules reject something anywhere? One diagnosis each of real arms and of plants of fresh seeds.

python -m validation.ablations.consulted [--only KIND ...] [--report] [--out out/consulted]
Each case is kept in the folder; the same command goes on where it stopped. Rules that rejected nothing in the ablation
study, and on real arms all that bought nothing there, are asked further: where one rejects, the case is diagnosed
without it.
"""

from __future__ import annotations

import argparse
import json
import os
import re
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any

from lagnet.diagnosis.diagnose import Diagnosis, diagnose
from lagnet.diagnosis.rules.candidate import Candidate
from lagnet.diagnosis.rules.catalogue import RULES
from lagnet.diagnosis.rules.rule import Rejection, RejectionRule
from lagnet.errors import LagnetError
from lagnet.files import write_whole
from validation.ablations import consulted_cases
from validation.ablations.consulted_cases import Case, Posed
from validation.ablations.consulted_summary import differences, slug, summary, table
from validation.ablations.names_alone import NAMES_ALONE
from validation.ablations.taken_out import taken_out
from validation.ablations.watched import Effects, WatchedRule
from validation.another_simulator.mujoco_arm import CameApartError
from validation.concealed.code import fingerprint

HERE = Path(__file__).resolve().parent
CODE = fingerprint()
Unproven = Callable[[str], Sequence[str]]
"""Rules to leave out where they reject something, by kind of data."""
PLANTS = {"simulated": 48, "textured": 24, "unlisted": 8, "late_logs": 4, "far_models": 30, "another_simulator": 46}


class Listener(WatchedRule):
    """A rule that writes down what it takes out of a selection, in reruns too."""

    def __init__(self, rule: RejectionRule, heard: Counter) -> None:
        super().__init__(rule, {}, Effects())
        self.heard = heard

    def rejected(self, candidate: Candidate) -> tuple[Rejection, ...]:
        """What the rule rejects."""
        found = self.rule.rejected(candidate)
        self.heard.update(place_of(r) for r in (found if self.rule.together else found[:1]))
        return found


def place_of(rejection: Rejection) -> str:
    """The rule, and the effect and joint that it rejects."""
    where = "arm" if rejection.joint is None else str(rejection.joint)
    return f"{rejection.rule}: {rejection.effect} @ {where}"


def asked(posed: Posed) -> dict[str, Any]:
    """Rejections at any point and those of the verdict, names and held-out errors."""
    heard: Counter = Counter()
    whole = _diagnosed(posed, [Listener(r, heard) for r in RULES])
    rejected = sorted({place_of(r) for r in whole.state.rejected})
    return {"at_any_point": dict(heard), "in_the_verdict": rejected, **told(whole), "without": {}}


def ask_further(posed: Posed, found: dict[str, Any], unproven: Sequence[str]) -> None:
    """Asks without each rule of `unproven` that rejected something, where that is not yet known."""
    for name in open_rules(found, unproven):
        found["without"][name] = told(_diagnosed(posed, [r for r in RULES if r.name != name]))


def open_rules(found: dict[str, Any], unproven: Sequence[str]) -> list[str]:
    """Rules of `unproven` that rejected something, without which a case has not been diagnosed."""
    spoke = {place.partition(":")[0] for place in found["at_any_point"]}
    return [rule for rule in unproven if rule in spoke and rule not in found["without"]]


def told(result: Diagnosis) -> dict[str, Any]:
    """Names with their ties and parameters, and the held-out error of what is named at each joint."""
    names = {
        f"{e.effect} @ {e.joint}" + "".join(f" | {t}" for t in e.tied_with): {
            p.name: [p.value, *p.ci95] for p in e.parameters
        }
        for e in result.effects
    }  # a load mounted twice stands once for each recording
    return {"names": names, "nmse_named": [f.nmse_named for f in result.verdict.fit]}


def _diagnosed(posed: Posed, rules: Sequence[RejectionRule]) -> Diagnosis:
    robot, fit, held = posed
    with taken_out(NAMES_ALONE):
        return diagnose(fit, robot, held, rules=rules, seed=0)


def every_case(data: Path, home: Path, only: Sequence[str]) -> Iterator[Case]:
    """All cases, real arms first; `only`: of these kinds."""
    every = (
        *consulted_cases.real_arms(data, home),
        *consulted_cases.concealed(data, home, PLANTS["simulated"], PLANTS["textured"]),
        *consulted_cases.unlisted(home, PLANTS["unlisted"]),
        *consulted_cases.late_logs(data, home, PLANTS["late_logs"]),
        *consulted_cases.far_models(PLANTS["far_models"]),
        *consulted_cases.another_simulator(PLANTS["another_simulator"]),
    )
    return (case for case in every if not only or case.kind in only)


def conduct(every: Iterator[Case], unproven: Unproven, home: Path) -> None:
    """Ask every case for what is not kept already."""
    for case in every:
        file = home / case.kind / f"{slug(case.name)}.json"
        found = json.loads(file.read_text()) if file.exists() else {}
        if found and not open_rules(found, unproven(case.kind)):
            continue
        try:
            posed, hidden = case.posed()
            found = found or {"kind": case.kind, "name": case.name, "hidden": hidden, **asked(posed)}
            ask_further(posed, found, unproven(case.kind))
        except (CameApartError, LagnetError) as refused:  # neither has a verdict
            print(case.kind, case.name, refused, flush=True)
            continue
        file.parent.mkdir(parents=True, exist_ok=True)
        write_whole(file, json.dumps(found, indent=1).encode())
        print(case.kind, case.name, *sorted({p.partition(":")[0] for p in found["at_any_point"]}), flush=True)


def of_the_study(kind: str) -> list[str]:
    """Rules to ask further: those that rejected nothing in the study; on real arms, all that buy nothing there."""
    result = json.loads((HERE / "result.json").read_text())
    return result["rules_that_buy_nothing" if kind == "real_arms" else "rules_that_rejected_nothing"]


def main() -> int:
    """Ask, then write `consulted.json` and its table in README.md."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    kinds = ("real_arms", "real_splits", *PLANTS)
    parser.add_argument("--only", nargs="*", choices=kinds, default=(), help="these kinds of data; writes no result")
    parser.add_argument("--report", action="store_true", help="run nothing, write the result of what is finished")
    default = os.environ.get("LAGNET_DATA_DIR", str(HERE.parents[2] / "shared" / "data"))
    parser.add_argument("--data", type=Path, default=Path(default), help="folder of the data sets (LAGNET_DATA_DIR)")
    parser.add_argument("--out", type=Path, default=Path("out") / "consulted")
    given = parser.parse_args()
    home = given.out / "cases" / CODE[:12]
    if not given.report:
        conduct(every_case(given.data, given.out, given.only), of_the_study, home)
    if given.only:
        return 0
    kept = [json.loads(file.read_text()) for kind in kinds for file in sorted((home / kind).glob("*.json"))]
    result = {"code": CODE, "rules": summary(kept), "without": differences(kept)}
    (HERE / "consulted.json").write_text(json.dumps(result, indent=1, ensure_ascii=False) + "\n")
    page = HERE / "README.md"
    text = f"<!-- consulted -->\n{table(result['rules'])}\n<!-- /consulted -->"
    page.write_text(
        re.sub(r"<!-- consulted -->.*?<!-- /consulted -->", lambda _: text, page.read_text(), flags=re.DOTALL)
    )
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
