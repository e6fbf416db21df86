from scanplan.project import run_lock, run_outcome

THIS_RUN = run_lock.FolderRun()


# before the jobs are worked out: while another run is at work, files come and go
if workflow.is_main_process:
    or_end(run_lock.lock_folder).close()


onstart:
    or_end(THIS_RUN.begin)
    for name, dataset in GIVEN.items():
        begin_results(name, dataset.source)


onsuccess:
    for name in GIVEN:
        discard_lone_note(name)
    if "thesis" in workflow.dag_settings.targets:
        print(f"\nreport:  results/{RESERVED}/report.html", file=sys.stderr)
    if not workflow.dag_settings.targets and not workflow.dag_settings.until:
        for name, dataset in GIVEN.items():
            end_results(name, dataset.source)
            print(run_outcome.describe_results(name), file=sys.stderr)


onerror:
    for name in GIVEN:
        discard_lone_note(name)
    layers = {name: dataset.layers for name, dataset in DATASETS.items()}
    layers[RESERVED] = ()
    run_outcome.remove_empty_folders(layers)
    for line in run_outcome.describe_failure(THIS_RUN, layers):
        print(f"scanplan: {line}", file=sys.stderr)
    # whatever Snakemake would add says less
    raise SystemExit(1)
