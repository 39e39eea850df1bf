use slcbeam::case;
use slcbeam::run::{dynamics, record::Memory};
fn main(){
 let args: Vec<String> = std::env::args().skip(1).collect();
 let l = case::load(std::path::Path::new(&args[0]), &args[1..]).unwrap();
 let mut m = Memory::default();
 let o = dynamics::run(&l.case, &mut m).unwrap();
 println!("{}", serde_json::to_string_pretty(&o.summary).unwrap());
 if let Some(f)=o.fault { println!("{f:?}"); }
}
