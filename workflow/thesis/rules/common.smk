from scanplan.project import stage_settings
from scanplan.selection import methods
from thesis import shown_figures, stated_claims

# by kind
THESIS = product.SURVEYS


def code_of(stage):
    """A param function: a digest of the helpers that a stage of the laboratory imports."""
    return product.code_of(f"thesis/stages/{stage}")


def page_files(*names):
    """Files that a page of the thesis's experiments is made from: template and style."""
    return product.page_files(*names, folder="workflow/thesis/page")


def all_selections(wildcards):
    """Orderings of all methods of one dataset."""
    return [
        f"results/{wildcards.dataset}/selection/{method}.parquet"
        for method in product.METHODS
    ]


def all_walls(wildcards):
    """Walls by all compared extractors of one dataset."""
    return [
        f"results/{wildcards.dataset}/walls/{extractor}.parquet"
        for extractor in product.compared_extractors(wildcards.dataset)
    ]


def extraction_times(wildcards):
    """Run times of all compared extractors of one dataset."""
    return [
        f"benchmarks/{wildcards.dataset}/{times}.tsv"
        for extractor in product.compared_extractors(wildcards.dataset)
        for times in product.timed(f"extract_walls_{extractor}", wildcards.dataset)
    ]


def compared(name):
    """All results of a dataset, with those of the comparison."""
    return product.results_of(name) + product.comparison_of(name)


wildcard_constraints:
    dataset=product.match_names(product.DATASETS),
