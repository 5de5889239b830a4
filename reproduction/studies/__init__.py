"""All studies, in the order in which they are made: a study follows those whose pages it reads."""

from reproduction.studies import (
    assumptions,
    avaframe,
    checked_numbers,
    columns,
    frank_page,
    joffre_judged_page,
    joffre_page,
    laboratory_page,
    lamplugh_force,
    lamplugh_results,
    notebooks,
    paper,
    pictures,
    refinement_page,
    reliability,
    tutorials,
    verification,
)

MODULES = (
    paper,
    pictures,
    lamplugh_results,
    assumptions,
    columns,
    lamplugh_force,
    verification,
    laboratory_page,
    refinement_page,
    avaframe,
    frank_page,
    notebooks,
    tutorials,
    reliability,
    joffre_page,
    joffre_judged_page,
    checked_numbers,
)
STUDIES = {module.STUDY.name: module.STUDY for module in MODULES}
